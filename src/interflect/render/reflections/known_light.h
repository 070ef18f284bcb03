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

/// Irradiance of every element of a solution.
struct KnownIrradiance {
    const ElementForest& forest;
    std::span<const Rgb> irradiance;  ///< After noise reduction [as H].
    std::span<const Rgb> unreduced;   ///< Solution::unreduced_irradiance or, if that is empty, `irradiance`.
    bool is_interpolated = false;     ///< Whether an IndirectField replaces gathering (hybrid shading).
};

/// Reflected light of a solution, for final gathering. sample() omits dim elements, so combine it with sampled
/// directions. Constant methods are thread-safe.
class KnownLight {
  public:
    /// Until sample_brighter_than() is called, sample() returns no place. Arguments must outlive this, except `known`
    /// itself. Only the irradiance of leaves is used.
    KnownLight(const Scene& scene, std::span<const PatchGeometry> geometry, const KnownIrradiance& known);

    /// Restricts sample() to elements of greater reflected radiosity.
    /// @param radiosity  Sum of channels [lm/m^2 or W/m^2].
    void sample_brighter_than(float radiosity);
    /// Multiplies sampling_powers() by a weight per patch, > 0.
    void weigh(std::span<const float> weights);

    /// Returns the power of each patch to which sample() is proportional, sum of channels [lm or W].
    std::span<const float> sampling_powers() const { return power_; }

    /// Point on a leaf of the solution.
    struct Place {
        PatchIndex patch;
        ElementIndex leaf;
        Parameters parameters;
    };
    Place place(PatchIndex patch, const V3f& x) const;
    int element_level(PatchIndex patch, const V3f& x) const { return forest_.level(place(patch, x).leaf); }

    /// Returns the irradiance after noise reduction.
    const Rgb& irradiance(const Place& place) const { return irradiance_[place.leaf]; }
    /// Returns the radiance before noise reduction, which would bias its mean over many places.
    Rgb reflected_radiance(const Place& place) const;

    /// Whether the leaf fills a small solid angle at this squared distance [m^2]. Otherwise its constant radiosity
    /// would be visible.
    bool is_far(const Place& place, float distance2) const {
        constexpr float max_solid_angle = 0.25f;  // [sr]
        return forest_.area(place.leaf) <= max_solid_angle * distance2;
    }

    struct Sample {
        Place place;
        float density = 0;  ///< Density of the sample [1/m^2].
    };
    /// Samples a bright point that may illuminate x on a surface with normal n; its patch may be `none`.
    /// @param choice  Selects the patch; in (0, 1).
    /// @param u, v    In [0, 1).
    Sample sample(const V3f& x, const V3f& n, double choice, float u, float v) const;
    /// Returns the density of sample() [1/m^2].
    float density(const Place& place, const V3f& x, const V3f& n) const;

  private:
    /// Returns the density of sample() within the chosen patch [1/m^2].
    float density_in_patch(const Place& place) const {
        return excess_[place.leaf] / (excess_[place.patch] * forest_.area(place.leaf));
    }

    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    const ElementForest& forest_;
    std::span<const Rgb> irradiance_, unreduced_;
    std::vector<float> excess_;  // power of each element above the limit of radiosity, sum of channels [lm or W]
    std::vector<float> power_;   // weighted power of each patch above the limit [lm or W]
    LightTree tree_;
};

}  // namespace interflect::detail
