#pragma once

#include <ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"

namespace interflect::detail {

using V3d = Imath::V3d;

/// Returns the unoccluded form factor from a differential area at x to a convex polygon: Lambert's sum over the edges
/// (1760; Baum et al. 1989) of the part above the horizon of the area.
/// @param normal Unit normal at x.
/// @param polygon Three to seven corners [m], counter-clockwise as seen from its lit side.
/// @return In [0, 1]; 0 if x is behind the polygon's plane.
double form_factor_to_polygon(const V3d& x, const V3d& normal, std::span<const V3d> polygon);

/// Two elements that may exchange light.
struct ElementPair {
    std::uint32_t a, b;
};

/// Light exchanged by two elements, in both directions.
struct Exchange {
    /// Unoccluded A_a F_ab = A_b F_ba [m^2].
    float area = 0;
    /// Variation of the unoccluded exchange over a, and over b: the element's area times the difference between the
    /// largest and the smallest form factor from its points to the other element [m^2].
    float spread_over_a = 0, spread_over_b = 0;
    /// Transmitted share of `area`, in [0, 1]: the mean over lines of sight. A free line counts 1, a blocked one 0, and
    /// any other the transmittance of its panes.
    Rgb transmittance{0, 0, 0};
    /// Largest difference of the transmittance between two lines of sight, in [0, 1].
    float variation = 0;
};

/// Sampling effort for an exchange: the number of points along each side of the smaller element. Each point has one
/// line of sight.
enum class Effort { quick = 2, thorough = 4 };

/// Estimator of the exchange between elements. The unoccluded part is Lambert's closed form over the larger element,
/// integrated over the smaller one by Gaussian quadrature. It is free of noise, and exact in the limit of small
/// elements. Visibility is sampled along lines between the Gauss points and points distributed over the larger element.
/// A line is free if a ray from each end first hits the other end, apart from panes. Thread-safe.
class ExchangeEstimator {
  public:
    /// @param seed Seed of the points. They depend only on it and on the positions of the two elements in the forest.
    ExchangeEstimator(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, std::uint64_t seed)
        : forest_(forest), ray_caster_(ray_caster), panes_(scene, ray_caster), seed_(seed) {}

    /// Returns whether each element extends above the plane of the other by more than rounding.
    bool face_each_other(const ElementPair& pair) const;

    /// @param rays Incremented by the number of traced rays, at most 2 effort^2.
    Exchange estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const;

  private:
    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    Panes panes_;
    std::uint64_t seed_;
};

}  // namespace interflect::detail
