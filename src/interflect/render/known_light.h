#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/render/light_tree.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// The light of a solution, which final gathering looks up at its elements. What is bright is sampled like an emitter:
/// a patch by LightTree, by the power that it reflects, then an element below it in proportion to what arrives there.
/// Immutable, shared by all threads; 4 bytes an element, 132 a patch.
class KnownLight {
  public:
    /// @param irradiance  Of every element; that of leaves counts. All arguments must outlive this.
    KnownLight(const Scene& scene, std::span<const PatchGeometry> geometry, const ElementForest& forest,
               std::span<const Rgb> irradiance);

    /// A point of a patch, and the leaf that it lies in.
    struct Place {
        std::uint32_t patch = none, leaf = none;
        Parameters parameters;
    };
    Place place(std::uint32_t patch, const V3f& x) const;
    int level(std::uint32_t patch, const V3f& x) const { return forest_.level(place(patch, x).leaf); }

    /// rho H / pi where `place` is, the radiance that leaves it by reflection.
    Rgb radiance(const Place& place) const;

    /// Whether the leaf is so small, seen from a point at this distance, that its one value may be gathered: no more
    /// than a quarter of a steradian, A / d^2.
    bool is_far(const Place& place, float distance2) const {
        constexpr float largest_angle = 0.25f;
        return forest_.area(place.leaf) <= largest_angle * distance2;
    }

    /// A point that may light x, on a surface with normal n; patch none where nothing does.
    /// @param uniform  In (0, 1). @param u, v  In [0, 1).
    Place sample(const V3f& x, const V3f& n, double uniform, float u, float v) const;
    /// The density per area of sample() at `place` [1/m^2].
    float density(const Place& place, const V3f& x, const V3f& n) const;

  private:
    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    const ElementForest& forest_;
    std::span<const Rgb> irradiance_;
    std::vector<float> received_;  // power that arrives at each element, all channels together [lm or W]
    LightTree tree_;
};

}  // namespace interflect::inline detail
