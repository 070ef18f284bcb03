#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/deposit/ray_pairs.h"
#include "interflect/solver/deposit/transport_step.h"

namespace interflect::detail {

/// Paths of shooters, from the root to the leaf that shot a ray, for all rays in flight.
class SourcePaths {
  public:
    /// Range of shooters; the root is the first.
    struct Path {
        std::uint32_t first = 0, last = 0;
    };

    /// The arguments must outlive this.
    SourcePaths(ElementForest& forest, const TransportStep& step) : forest_(forest), step_(step) {}

    Path append_leaf(ElementIndex leaf);
    Path append_part(std::uint32_t part, const Ray& ray, const Hit& hit);
    void clear() { sources_.clear(); }

    /// Starts lane i at the first shooter of its path. @param reflectance  Reflectance rho_i of the hit patch.
    void begin(RayPairs& pairs, std::size_t i, const Path& path, const Rgb& reflectance) const {
        pairs.lowest_shooter[i] = path.last;
        pairs.shooter_normal.set(i, sources_[path.first].normal);
        pairs.shooter_least_cosine[i] = sources_[path.first].min_cosine;
        set_shooter(pairs, i, path.first, reflectance);
    }

    static bool shooter_is_too_large(const RayPairs& pairs, std::size_t i) {
        const float shooter = pairs.shooter_area[i], receiver = pairs.area[i];
        const std::uint32_t number = pairs.shooter[i], lowest = pairs.lowest_shooter[i];
        return (shooter > receiver) & (number < lowest);
    }

    /// Selects the largest shooter that is not larger than the receiver. If there is none, selects the lowest shooter.
    void choose_shooter(RayPairs& pairs, std::size_t i, const Rgb& reflectance) const {
        std::uint32_t number = pairs.shooter[i] + 1;
        while (number < pairs.lowest_shooter[i] && sources_[number].area > pairs.area[i]) ++number;
        set_shooter(pairs, i, number, reflectance);
    }

    /// Divides the lowest shooter and continues at its child. Returns false if it is indivisible.
    bool subdivide(RayPairs& pairs, std::size_t i, const Parameters& start, const Rgb& reflectance, bool may_grow);

  private:
    struct Shooter {
        ElementIndex element;  // no_element for a luminaire part
        Cell cell;
        V3f centre, normal;
        float area;  // [m^2]
        float min_cosine;
        Rgb radiosity{0, 0, 0};
    };

    /// Sets the shooter of lane i to sources_[number].
    void set_shooter(RayPairs& pairs, std::size_t i, std::uint32_t number, const Rgb& reflectance) const {
        const Shooter& shooter = sources_[number];
        pairs.shooter[i] = number;
        pairs.shooter_centre.set(i, shooter.centre);
        pairs.shooter_area[i] = shooter.area;
        pairs.reflected[i] = largest_channel(Rgb(reflectance * shooter.radiosity));
    }

    ElementForest& forest_;
    const TransportStep& step_;
    std::vector<Shooter> sources_;
};

/// Returns the first child, or no_element if the element has no children and the forest may not grow.
inline ElementIndex find_or_create_children(ElementForest& forest, ElementIndex element, bool may_grow) {
    const ElementIndex child = forest.first_child(element);
    return child == no_element && may_grow ? forest.subdivide(element) : child;
}

}  // namespace interflect::detail
