#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"

namespace interflect::inline detail {

using V3d = Imath::V3d;

/// The form factor from a small piece of surface at x to a convex polygon that nothing hides: Lambert's sum over the
/// edges (1760; Baum et al. 1989) of the part above the surface's horizon.
/// @param normal   Of the surface, unit length.
/// @param polygon  Three to seven corners [m], counter-clockwise seen from its lit side.
/// @return         In [0, 1]; 0 where x is behind the polygon's plane.
double form_factor_to_polygon(const V3d& x, const V3d& normal, std::span<const V3d> polygon);

/// Two elements that may exchange light.
struct ElementPair {
    std::uint32_t a, b;
};

/// What two elements exchange, in both directions.
struct Exchange {
    /// A_a F_ab = A_b F_ba if nothing stood between them [m^2].
    float area = 0;
    /// How much that varies over a, and over b, unoccluded: the element's area times the difference between the form
    /// factors to the other element from those of its points that see most and least of it [m^2].
    float spread_over_a = 0, spread_over_b = 0;
    /// The share of `area` that arrives, in [0, 1]: the mean over lines of sight, 1 for a free line, 0 for a blocked
    /// one, the transmittance of the panes for others.
    Rgb transmittance{0, 0, 0};
    /// The largest difference between two lines of sight, in [0, 1].
    float variation = 0;
};

/// How closely an exchange is looked at: so many points, squared, on the smaller element, and a line of sight from
/// each.
enum class Effort { quick = 2, thorough = 4 };

/// Estimates what pairs of elements exchange. The unoccluded part is Lambert's closed form over the larger element,
/// integrated over the smaller one by Gauss' rule: no noise, and exact in the limit of small elements. Visibility is
/// sampled along lines between Gauss' points and points spread over the larger element; a line is free where each end
/// is the first thing that a ray from the other meets, panes left out. May be called by any number of threads.
class ExchangeEstimator {
  public:
    /// @param seed  Of the points; these depend on it and on the two elements' places in the forest alone.
    ExchangeEstimator(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, std::uint64_t seed)
        : forest_(forest), ray_caster_(ray_caster), panes_(scene, ray_caster), seed_(seed) {}

    /// Whether each of the two reaches above the other's plane, by more than rounding.
    bool face_each_other(const ElementPair& pair) const;

    /// @param rays  Receives the number of rays that it took, at most 2 effort^2.
    Exchange estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const;

  private:
    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    Panes panes_;
    std::uint64_t seed_;
};

}  // namespace interflect::inline detail
