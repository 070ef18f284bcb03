#pragma once

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

/// An element on the way down from a root, with what the oracle asks of it.
struct Visit {
    const PatchGeometry* geometry = nullptr;  // of its patch
    std::uint32_t element = none;
    Cell cell;
    Party party;
    Rgb radiosity{0, 0, 0};  // of the nearest element that was there when the step began: a new one inherits it
    float importance = 0;    // likewise
};

/// The state that a step starts from, and the way down the trees of the forest.
class Descent {
  public:
    /// @param forest  Grows as it is subdivided.
    Descent(ElementForest& forest, const TransportStep& step)
        : forest_(forest), step_(step), old_size_(forest.size()) {}

    std::uint32_t old_size() const { return old_size_; }  ///< Of the forest, when the step began.
    const ElementForest& forest() const { return forest_; }

    Visit root(std::uint32_t patch) const;
    /// Goes to the child that holds p, if there is one. @return whether there was.
    bool go_down(Visit& v, Parameters p) const;
    /// The same; makes the children first where there are none.
    bool subdivide(Visit& v, Parameters p) const;
    /// The leaf that holds p, an old element, above or below an element that holds it too.
    std::uint32_t old_leaf_at(const Visit& v, Parameters p) const;

  private:
    bool go_to(Visit& v, std::uint32_t first_child, Parameters p) const;
    void enter(Visit& v, std::uint32_t element, const Cell& cell) const;

    ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t old_size_;
};

/// What left the scene.
struct Escaped {
    FixedPoint::Value power{};
    std::int64_t rays = 0;
};

/// The receiving end of a step, for one thread: finds the elements that what the rays carry arrives at. Rays are taken
/// in groups, which walk down the trees side by side: so the processor looks up one's elements while it waits for
/// another's.
class Receiver {
  public:
    /// All arguments must outlive this.
    Receiver(const Surfaces& surfaces, const Descent& descent, const TransportStep& step, Arrivals& arrivals)
        : surfaces_(surfaces),
          descent_(descent),
          step_(step),
          arrivals_(arrivals),
          refines_(step.oracle.refines && step.carries_power()),
          sorter_(arrivals) {}

    /// Takes rays of leaf number s into the group. @param origins  Their parameters on the leaf's patch.
    void take(std::uint32_t s, std::span<const Ray> rays, std::span<const Parameters> origins,
              std::span<const Hit> hits);
    /// Sends on what the group's rays carry, and begins a new one.
    void finish_group();
    /// To be called at the end. @return What escaped from this thread's rays.
    Escaped finish();

  private:
    /// The two ends of a ray.
    struct Pair {
        std::uint32_t source = 0;
        std::uint32_t patch = none;          // that was hit
        std::uint32_t depth = 0;             // of the shooter on its way,
        std::uint32_t way = 0, way_end = 0;  // a part of ways_, down to the leaf that the ray starts on
        Parameters x, y;                     // of the ends on their patches
        Visit shooter, receiver;
        Rgb reflectance{0, 0, 0};
    };

    void find_way_to_leaf(std::uint32_t leaf);
    void find_receivers();
    bool is_settled(const Pair& pair) const;
    bool divide(Pair& pair) const;
    void send(const Pair& pair);

    const Surfaces& surfaces_;
    const Descent& descent_;
    const TransportStep& step_;
    const Arrivals& arrivals_;
    bool refines_;
    Arrivals::Sorter sorter_;
    Escaped escaped_;
    std::vector<Pair> pairs_;
    std::vector<Visit> ways_;
    std::vector<std::uint32_t> open_;  // pairs that the oracle has not accepted yet
};

}  // namespace interflect
