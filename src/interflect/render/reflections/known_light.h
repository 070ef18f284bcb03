#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reflected light of a solution, for final gathering. sample() omits dim elements: combine it with sampled directions.
/// Constant methods are thread-safe.
class KnownLight {
  public:
    /// sample() returns no place until sample_brighter_than().
    /// @param irradiance  Per element; only leaves are used. Arguments must outlive this.
    KnownLight(const Scene& scene, std::span<const PatchGeometry> geometry, const ElementForest& forest,
               std::span<const Rgb> irradiance);

    /// @param radiosity  Reflected [lm/m^2 or W/m^2], sum of channels.
    void sample_brighter_than(float radiosity);
    /// Multiplies sampling_powers(). @param weights  Above 0, per patch.
    void weigh(std::span<const float> weights);

    /// Emitted power of each patch, as sample() assumes, sum of channels [lm or W].
    std::span<const float> sampling_powers() const { return power_; }

    struct Place {
        PatchIndex patch;
        ElementIndex leaf;
        Parameters parameters;
    };
    Place place(PatchIndex patch, const V3f& x) const;
    int level(PatchIndex patch, const V3f& x) const { return forest_.level(place(patch, x).leaf); }

    const Rgb& irradiance(const Place& place) const { return irradiance_[place.leaf]; }
    Rgb reflected_radiance(const Place& place) const;

    /// Whether the leaf is small at this squared distance [m^2].
    bool is_far(const Place& place, float distance2) const {
        constexpr float max_solid_angle = 0.25f;  // [sr]
        return forest_.area(place.leaf) <= max_solid_angle * distance2;
    }

    struct Sample {
        Place place;
        float density = 0;  ///< [1/m^2]
    };
    /// Samples a bright point that may illuminate x on a surface with normal n; its patch may be `none`.
    /// @param choice  Selects the patch; in (0, 1).
    /// @param u, v    In [0, 1).
    Sample sample(const V3f& x, const V3f& n, double choice, float u, float v) const;
    /// Density of sample() [1/m^2].
    float density(const Place& place, const V3f& x, const V3f& n) const;

  private:
    /// Density of sample() once it has chosen the patch [1/m^2].
    float density_in_patch(const Place& place) const {
        return excess_[place.leaf] / (excess_[place.patch] * forest_.area(place.leaf));
    }

    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    const ElementForest& forest_;
    std::span<const Rgb> irradiance_;
    std::vector<float> excess_;  // power above the limit, sum of channels [lm or W]
    std::vector<float> power_;   // of patches
    LightTree tree_;
};

}  // namespace interflect::detail
