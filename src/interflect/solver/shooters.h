#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/ray_pairs.h"
#include "interflect/solver/transport.h"

namespace interflect {

/// What the rays in flight left, as the oracle sees it: the ancestor path of every leaf that shot them, of which each
/// pair takes the element that suits its receiver.
class Shooters {
  public:
    /// A path, from the largest to the smallest, as numbers of shooters.
    struct Path {
        std::uint32_t first = 0, last = 0;
    };

    /// Both arguments must outlive this.
    Shooters(ElementForest& forest, const TransportStep& step) : forest_(forest), step_(step) {}

    /// Appends the elements that hold a leaf, from its root to itself.
    Path append_leaf(std::uint32_t leaf);
    /// Appends what stands for a part of a luminaire near one of its rays.
    Path append_part(std::uint32_t part, const Ray& ray, const Hit& hit);
    void clear() { shooters_.clear(); }

    /// Begins with the first of the path. @param reflectance  rho_i of the patch that was hit.
    void begin(RayPairs& pairs, std::size_t i, const Path& path, const Rgb& reflectance) const {
        pairs.lowest_shooter[i] = path.last;
        pairs.shooter_normal.set(i, shooters_[path.first].normal);
        pairs.shooter_least_cosine[i] = shooters_[path.first].least_cosine;
        take(pairs, i, path.first, reflectance);
    }

    static bool is_too_large(const RayPairs& pairs, std::size_t i) {
        const float shooter = pairs.shooter_area[i], receiver = pairs.area[i];
        const std::uint32_t number = pairs.shooter[i], lowest = pairs.lowest_shooter[i];
        return (shooter > receiver) & (number < lowest);
    }

    /// Lets the pair's shooter be the largest element of its path that is no larger than the receiver, or the lowest.
    /// Between larger ones and the receiver no verdict is asked for: what is received is the same for all of them.
    void choose(RayPairs& pairs, std::size_t i, const Rgb& reflectance) const {
        std::uint32_t number = pairs.shooter[i] + 1;
        while (number < pairs.lowest_shooter[i] && shooters_[number].area > pairs.area[i]) ++number;
        take(pairs, i, number, reflectance);
    }

    /// The pair's shooter, which is the lowest of its path, becomes its child that holds the start of the ray.
    /// @return whether there is one, or may be.
    bool subdivide(RayPairs& pairs, std::size_t i, const Parameters& start, const Rgb& reflectance, bool may_grow);

  private:
    struct Shooter {
        std::uint32_t element;  // none: a part of a luminaire
        Cell cell;
        V3f centre, normal;
        float area;  // [m^2]
        float least_cosine;
        Rgb radiosity{0, 0, 0};  // of the nearest element that was there when the step began: a new one inherits it
    };

    void take(RayPairs& pairs, std::size_t i, std::uint32_t number, const Rgb& reflectance) const {
        const Shooter& shooter = shooters_[number];
        pairs.shooter[i] = number;
        pairs.shooter_centre.set(i, shooter.centre);
        pairs.shooter_area[i] = shooter.area;
        pairs.reflected[i] = largest_channel(Rgb(reflectance * shooter.radiosity));
    }

    ElementForest& forest_;
    const TransportStep& step_;
    std::vector<Shooter> shooters_;
};

/// The first child; makes the children where there are none and there may be more elements. @return none: none.
inline std::uint32_t children_on_demand(ElementForest& forest, std::uint32_t element, bool may_grow) {
    const std::uint32_t child = forest.first_child(element);
    return child == none && may_grow ? forest.subdivide(element) : child;
}

}  // namespace interflect
