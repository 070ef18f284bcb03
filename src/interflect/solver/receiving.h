#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "interflect/base/fixed_point.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/gathering.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/transport.h"

namespace interflect {

/// What left the scene.
struct Escaped {
    FixedPoint::Value power{};
    std::int64_t rays = 0;
};

/// The receiving end of a step, for one thread: finds the elements at which the payload of each ray arrives. A
/// structure-of-arrays traversal with lane refill: many rays descend the quadtrees together, one level at a time, and
/// the next ray takes the lane of one that has arrived. This hides memory latency and lets the compiler vectorise.
class Receiver {
  public:
    /// @param old_size  Elements of the forest when the step began. All other arguments must outlive this.
    /// @param gathered  Receives the importance that rays find; null: they look for none.
    Receiver(const Materials& materials, ElementForest& forest, const TransportStep& step, std::uint32_t old_size,
             Arrivals& arrivals, GatheredImportance* gathered)
        : materials_(materials),
          forest_(forest),
          step_(step),
          old_size_(old_size),
          refines_(step.oracle.refines && step.carries_power()),
          needs_leaf_(!refines_ || (step.carries_importance() && !step.importance_at_patches)),
          buffer_(arrivals),
          gathered_(gathered) {
        std::iota(open_.begin(), open_.end(), 0u);
        pairs_.next.fill(none);
    }

    /// Takes rays of one source.
    /// @param source        A leaf, or elements when the step began + a part of a luminaire.
    /// @param contribution  What each carries. @param of_groups  Of that, the power of each light group.
    /// @param origins       Their parameters on the leaf's patch; of a part's rays they mean nothing.
    void take(std::uint32_t source, const Arrivals::Contribution& contribution, std::span<const std::int64_t> of_groups,
              std::span<const Ray> rays, std::span<const Parameters> origins, std::span<const Hit> hits);
    /// Tells the processor that a ray will be taken soon.
    void prefetch(const Hit& hit) const;
    /// To be called at the end of a task: rays must not wait for those of another.
    void finish_batch();
    /// To be called at the end. @return What escaped from this thread's rays.
    Escaped finish();

  private:
    static constexpr std::size_t lanes = 64;  // rays in flight: what is known of them fits into the first-level cache
    using Floats = std::array<float, lanes>;
    using Numbers = std::array<std::uint32_t, lanes>;
    struct Vectors {
        Floats x, y, z;
        void set(std::size_t i, const V3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
        V3f operator[](std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
    };

    /// The two ends of every ray in flight, an array for each number.
    struct alignas(64) Pairs {
        // The patch that was hit (PatchGeometry::Shape), and where on it.
        Vectors origin, edge_u, edge_v, twist;
        Numbers is_triangle;
        Floats hit_u, hit_v;
        // The receiver: the lowest element above the hit that the oracle has come to.
        Numbers receiver, children;  // children: the first of four, as it was when they were looked up, or none
        Floats u, v, size;           // its cell
        Vectors normal;
        Floats area, importance;  // psi_i
        // The shooter: the lowest above the origin.
        Numbers shooter, lowest_shooter;  // among ancestors_; the lowest is the ray's leaf or a new element
        Vectors shooter_centre, shooter_normal;
        Floats shooter_area, reflected;  // reflected: the largest channel of rho_i B_j
        // Verdicts, and what follows from them.
        Numbers settled;    // power has arrived
        Numbers of_power;   // at this element; until it has, the receiver
        Numbers on_demand;  // what is to be divided has no children yet, or is the shooter
        Numbers goes_on;    // the ray is still in flight
        Numbers next;       // the first child of those that the receiver's place is taken by; none: it stays
    };
    /// What else must be known of a ray in flight.
    struct RayState {
        std::uint32_t source, patch;  // patch: that was hit
        std::uint32_t left;           // the leaf that the ray left, among left_
        Parameters start;             // on the patch that the ray left
        Rgb reflectance{0, 0, 0};     // rho_i
    };
    /// An element that holds the start of a ray, as the oracle sees it.
    struct Shooter {
        std::uint32_t element;
        Cell cell;
        V3f centre;              // [m]
        float area;              // [m^2]
        Rgb radiosity{0, 0, 0};  // of the nearest element that was there when the step began: a new one inherits it
    };

    using Lanes = std::array<std::uint32_t, lanes>;
    std::span<const std::uint32_t> open() const { return std::span(open_).first(open_count_); }
    template <class Condition>
    std::span<const std::uint32_t> open_lanes_if(Lanes& found, const Condition& condition) const;
    void append_ancestors(std::uint32_t leaf);
    void append_part(std::uint32_t part, const Ray& ray, const Hit& hit);
    void begin(std::uint32_t source, std::uint32_t left, const Ray& ray, const Parameters& start, const Hit& hit);
    void advance();
    void look_up_receiver(std::size_t i);
    bool shooter_is_too_large(std::size_t i) const;
    void choose_shooter(std::size_t i);
    void set_shooter(std::size_t i, std::uint32_t ancestor);
    void evaluate_oracle();
    void choose_next();
    void subdivide_on_demand(std::size_t i);
    bool subdivide_shooter(std::size_t i);
    std::uint32_t children_of(std::uint32_t element);
    void go_down();
    void send(std::size_t i);
    void gather(std::uint32_t left, std::uint32_t patch, std::uint32_t leaf);

    const Materials& materials_;
    ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t old_size_;
    bool refines_, needs_leaf_;
    Arrivals::ScatterBuffer buffer_;
    Escaped escaped_;
    GatheredImportance* gathered_;
    struct Left {
        std::uint32_t source;
        double found;  // importance, by its rays so far
    };
    std::vector<Left> left_;  // sources whose rays the task has taken
    Pairs pairs_{};
    std::array<RayState, lanes> rays_;
    Lanes open_;  // lanes in use come first, then the others
    std::size_t open_count_ = 0;
    std::vector<Shooter> ancestors_;  // paths from root to leaf, of the leaves that the rays in flight left
    std::uint32_t root_ancestor_ = 0, leaf_ancestor_ = 0;  // ends of the path of the rays being taken, among them
};

}  // namespace interflect
