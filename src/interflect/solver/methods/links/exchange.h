#pragma once

#include <ImathVec.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"
#include "interflect/solver/methods/links/patch_tree.h"

namespace interflect::detail {

using V3d = Imath::V3d;

/// Unoccluded form factor from a differential area at x to a convex polygon: Lambert's edge sum (1760; Baum et al.
/// 1989), clipped to the horizon. 0 behind the polygon.
/// @param normal   Unit length.
/// @param polygon  Three to seven corners [m], counter-clockwise from the lit side.
double form_factor_to_polygon(const V3d& x, const V3d& normal, std::span<const V3d> polygon);

/// Per channel.
inline Rgb smaller(const Rgb& x, const Rgb& y) { return {std::min(x.x, y.x), std::min(x.y, y.y), std::min(x.z, y.z)}; }
inline Rgb larger(const Rgb& x, const Rgb& y) { return {std::max(x.x, y.x), std::max(x.y, y.y), std::max(x.z, y.z)}; }

/// Counter-clockwise from the front.
class ConvexPolygon {
  public:
    ConvexPolygon() = default;
    ConvexPolygon(const ElementForest& forest, ElementIndex element);

    void add(const V3d& corner) { corner_[count_++] = corner; }
    std::span<const V3d> corners() const { return {corner_.data(), count_}; }
    /// Unoccluded form factor from a differential area, 0 if it is behind the element.
    double form_factor_from(const V3d& x, const V3d& normal) const;

  private:
    static constexpr std::size_t capacity = 8;  // clipping adds one corner

    V3d normal_{0, 0, 0};
    std::array<V3d, capacity> corner_;
    std::size_t count_ = 0;
};

struct PointOfElement {
    ElementIndex element;
    V3f position;
};

/// Identifies an element among all that the forest may ever have.
std::uint64_t place(const ElementForest& forest, ElementIndex element);

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

/// Points per side of the smaller element; lines of sight are its square.
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

    /// Returns the transmittance of the panes between two points; 0 if another surface hides one from the other.
    /// @param rays  Incremented.
    Rgb transmittance(const PointOfElement& x, const PointOfElement& y, std::int64_t& rays) const;

  private:
    Rgb one_way(const PointOfElement& from, const PointOfElement& to, std::int64_t& rays) const;

    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    Panes panes_;
    std::uint64_t seed_;
};

}  // namespace interflect::detail
