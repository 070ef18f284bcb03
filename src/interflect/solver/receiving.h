#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/fixed_point.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/surfaces.h"
#include "interflect/solver/transport.h"

namespace interflect {

/// What left the scene.
struct Escaped {
    FixedPoint::Value power{};
    std::int64_t rays = 0;
};

/// The receiving end of a step, for one thread: finds the elements that what the rays carry arrives at. Rays are taken
/// in groups, which walk down the trees side by side: so the processor looks up one's elements while it waits for
/// another's, and the oracle judges as many pairs at a time as its vectors are long.
class Receiver {
  public:
    /// @param old_size  Elements of the forest when the step began. All other arguments must outlive this.
    Receiver(const Surfaces& surfaces, ElementForest& forest, const TransportStep& step, std::uint32_t old_size,
             Arrivals& arrivals)
        : surfaces_(surfaces),
          forest_(forest),
          step_(step),
          old_size_(old_size),
          refines_(step.oracle.refines && step.carries_power()),
          sorter_(arrivals) {}

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
    /// Rays of a group: what is known of them fits into the first-level cache.
    static constexpr std::size_t group_rays = 128;

    /// An element on the way down a tree.
    struct Place {
        std::uint32_t element = none;
        Cell cell;
    };
    /// An element that holds the start of a ray, as the oracle sees it.
    struct Shooter {
        Place place;
        Party party;
        Rgb radiosity{0, 0, 0};  // of the nearest element that was there when the step began: a new one inherits it
    };
    /// The two ends of a ray.
    struct Pair {
        const PatchGeometry* geometry;  // of the patch that was hit
        std::uint32_t patch, source;
        std::uint32_t way, way_end;  // the shooter and those below it among ways_, down to the leaf the ray starts on
        Parameters x, y;             // of the ends on their patches
        Place receiver, leaf;        // what the oracle has come to; what was hit when the step began
        Place shooter;               // the lowest of the way, or a new element below it
    };
    /// What the oracle asks of a group's pairs, an array for each number.
    struct alignas(64) Parties {
        using Lanes = std::array<float, group_rays>;
        struct Vectors {
            Lanes x, y, z;
            void set(std::size_t i, const V3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
            V3f operator[](std::size_t i) const { return {x.data()[i], y.data()[i], z.data()[i]}; }
        };
        struct Ends {
            Vectors centre, normal;
            Lanes area;
            void set(std::size_t i, const V3f& c, float a) {
                centre.set(i, c);
                area[i] = a;
            }
            Party operator[](std::size_t i) const { return {centre[i], normal[i], area.data()[i]}; }
        };
        Ends shooter, receiver;
        Vectors reflectance;
        Lanes reflected, importance;  // rho_i B_j, its largest channel; psi_i
        std::array<std::uint32_t, group_rays> settled;
    };

    static void go_down(Place& place, std::uint32_t first_child, Parameters p, bool triangle);
    void add_pair(std::uint32_t source, const Ray& ray, const Parameters& origin, const Hit& hit);
    void finish_group();
    void find_way_to_leaf(std::uint32_t leaf);
    Shooter shooter_at(const PatchGeometry& geometry, const Place& place) const;
    void choose_shooter(std::size_t i);
    void find_receivers();
    void judge();
    bool divide_receiver(std::size_t i);
    void look_at_receiver(std::size_t i);
    bool divide_shooter(std::size_t i);
    std::uint32_t children_of(std::uint32_t element);
    void find_leaves();
    void send(const Pair& pair);

    const Surfaces& surfaces_;
    ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t old_size_;
    bool refines_;
    Arrivals::Sorter sorter_;
    Escaped escaped_;
    std::size_t count_ = 0;  // of the group's pairs
    std::array<Pair, group_rays> pairs_;
    std::array<std::uint32_t, group_rays> open_;
    Parties parties_;
    std::vector<Shooter> ways_;
};

}  // namespace interflect
