#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "interflect/base/fixed_point.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/gathering.h"
#include "interflect/solver/surfaces.h"
#include "interflect/solver/transport.h"

namespace interflect {

/// What left the scene.
struct Escaped {
    FixedPoint::Value power{};
    std::int64_t rays = 0;
};

/// The receiving end of a step, for one thread: finds the elements that what the rays carry arrives at. Many rays walk
/// down the trees side by side, one level at a time, and where one has arrived the next takes its place: so the
/// processor looks up one's elements while it waits for another's, and what is computed for all of them is vector code.
class Receiver {
  public:
    /// @param old_size  Elements of the forest when the step began. All other arguments must outlive this.
    /// @param gathered  Receives the importance that rays find; null: they look for none.
    Receiver(const Surfaces& surfaces, ElementForest& forest, const TransportStep& step, std::uint32_t old_size,
             Arrivals& arrivals, GatheredImportance* gathered)
        : surfaces_(surfaces),
          forest_(forest),
          step_(step),
          old_size_(old_size),
          refines_(step.oracle.refines && step.carries_power()),
          needs_leaf_(!refines_ || (step.carries_importance() && !step.importance_at_patches)),
          sorter_(arrivals),
          gathered_(gathered) {
        std::iota(open_.begin(), open_.end(), 0u);
        pairs_.next.fill(none);
    }

    /// Takes rays of one leaf. @param load  What each carries. @param origins  Their parameters on the leaf's patch.
    void take(std::uint32_t leaf, const Arrivals::Load& load, std::span<const Ray> rays,
              std::span<const Parameters> origins, std::span<const Hit> hits);
    /// Tells the processor that a ray will be taken soon.
    void prefetch(const Hit& hit) const;
    /// To be called at the end of a task: rays must not wait for those of another.
    void finish_batch();
    /// To be called at the end. @return What escaped from this thread's rays.
    Escaped finish();

  private:
    static constexpr std::size_t lanes = 64;  // rays under way: what is known of them fits into the first-level cache
    using Floats = std::array<float, lanes>;
    using Numbers = std::array<std::uint32_t, lanes>;
    struct Vectors {
        Floats x, y, z;
        void set(std::size_t i, const V3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
        V3f operator[](std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
    };

    /// The two ends of every ray under way, an array for each number.
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
        Numbers way, way_end;  // among ways_; way_end: the lowest, the leaf that the ray starts on or a new element
        Vectors shooter_centre, shooter_normal;
        Floats shooter_area, reflected;  // reflected: the largest channel of rho_i B_j
        // Verdicts, and what follows from them.
        Numbers settled;     // power has arrived
        Numbers of_power;    // at this element; until it has, the receiver
        Numbers is_special;  // what is to be divided has no children yet, or is the shooter
        Numbers goes_on;     // the ray is still under way
        Numbers next;        // the first child of those that the receiver's place is taken by; none: it stays
    };
    /// What else must be known of a ray under way.
    struct UnderWay {
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
    void find_way_to_leaf(std::uint32_t leaf);
    void set_out(std::uint32_t source, std::uint32_t left, const Ray& ray, const Parameters& start, const Hit& hit);
    void advance();
    void look_up_receiver(std::size_t i);
    bool shooter_is_too_large(std::size_t i) const;
    void choose_shooter(std::size_t i);
    void set_shooter(std::size_t i, std::uint32_t way);
    void judge();
    void plan();
    void divide_specially(std::size_t i);
    bool divide_shooter(std::size_t i);
    std::uint32_t children_of(std::uint32_t element);
    void go_down();
    void send(std::size_t i);
    void gather(std::uint32_t left, std::uint32_t patch, std::uint32_t leaf);

    const Surfaces& surfaces_;
    ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t old_size_;
    bool refines_, needs_leaf_;
    Arrivals::Sorter sorter_;
    Escaped escaped_;
    GatheredImportance* gathered_;
    struct Left {
        std::uint32_t leaf;
        double found;  // importance, by its rays so far
    };
    std::vector<Left> left_;  // leaves whose rays the task has taken
    Pairs pairs_{};
    std::array<UnderWay, lanes> rays_;
    Lanes open_;  // lanes in use come first, then the others
    std::size_t open_count_ = 0;
    std::vector<Shooter> ways_;            // of the sources of the rays under way: elements from the root to the leaf
    std::uint32_t way_ = 0, way_end_ = 0;  // the root and the leaf whose rays are being taken, among them
};

}  // namespace interflect
