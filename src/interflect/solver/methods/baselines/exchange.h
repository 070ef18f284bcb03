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

/// Unoccluded form factor from a differential area at x to a convex polygon: Lambert's edge sum (1760; Baum et al.
/// 1989), clipped to the horizon. 0 behind the polygon.
/// @param normal   Unit length.
/// @param polygon  Three to seven corners [m], counter-clockwise from the lit side.
double form_factor_to_polygon(const V3d& x, const V3d& normal, std::span<const V3d> polygon);

struct ElementPair {
    std::uint32_t a, b;
};

struct Exchange {
    /// Unoccluded A_a F_ab = A_b F_ba [m^2].
    float area = 0;
    /// Area times the range of form factors from its points [m^2].
    float spread_over_a = 0, spread_over_b = 0;
    /// Mean over lines of sight.
    Rgb transmittance{0, 0, 0};
    /// Range of the transmittance over lines of sight.
    float variation = 0;
};

/// Points per side of the smaller element.
enum class Effort { quick = 2, thorough = 4 };

/// Thread-safe. Integrates Lambert's form factor to the larger element over the smaller (Gaussian quadrature). A line
/// of sight is free if rays from both ends first hit the other, apart from panes.
class ExchangeEstimator {
  public:
    ExchangeEstimator(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, std::uint64_t seed)
        : forest_(forest), ray_caster_(ray_caster), panes_(scene, ray_caster), seed_(seed) {}

    /// Whether each extends above the other's plane by more than rounding.
    bool face_each_other(const ElementPair& pair) const;

    /// @param rays  Incremented.
    Exchange estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const;

  private:
    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    Panes panes_;
    std::uint64_t seed_;
};

}  // namespace interflect::detail
