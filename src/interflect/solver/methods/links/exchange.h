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

/// Returns the unoccluded form factor from a differential area at x to a convex polygon, by Lambert's sum over edges
/// (1760; Baum et al. 1989). The polygon is clipped to the horizon. Returns 0 if x is behind the polygon.
/// @param normal   Unit length.
/// @param polygon  Three to seven corners [m], counter-clockwise as seen from the lit side.
double form_factor_to_polygon(const V3d& x, const V3d& normal, std::span<const V3d> polygon);

/// Minimum and maximum of each channel.
inline Rgb smaller(const Rgb& x, const Rgb& y) { return {std::min(x.x, y.x), std::min(x.y, y.y), std::min(x.z, y.z)}; }
inline Rgb larger(const Rgb& x, const Rgb& y) { return {std::max(x.x, y.x), std::max(x.y, y.y), std::max(x.z, y.z)}; }

/// An element as a polygon; its corners are counter-clockwise as seen from the front.
class ConvexPolygon {
  public:
    ConvexPolygon() = default;
    ConvexPolygon(const ElementForest& forest, ElementIndex element);

    void add(const V3d& corner) { corner_[count_++] = corner; }
    std::span<const V3d> corners() const { return {corner_.data(), count_}; }
    /// Returns the unoccluded form factor from a differential area; 0 if the area is behind the element.
    double form_factor_from(const V3d& x, const V3d& normal) const;

  private:
    static constexpr std::size_t capacity = 8;  // form_factor_to_polygon() takes seven corners; clipping adds one

    V3d normal_{0, 0, 0};
    std::array<V3d, capacity> corner_;
    std::size_t count_ = 0;
};

struct PointOfElement {
    ElementIndex element;
    V3f position;
};

/// Returns a number that identifies an element among all possible elements of the forest.
std::uint64_t element_key(const ElementForest& forest, ElementIndex element);

struct Exchange {
    /// Unoccluded exchange A_a F_ab = A_b F_ba [m^2].
    float area = 0;
    /// Area of the end, times the range of form factors from its points to the other end [m^2].
    float spread_over_a = 0, spread_over_b = 0;
    /// Mean transmittance of lines of sight.
    Rgb transmittance{0, 0, 0};
    /// Range of the transmittance over lines of sight.
    float variation = 0;
};

/// Number of points per side of the smaller element. The number of lines of sight is its square.
enum class Effort { quick = 2, thorough = 4 };

/// Estimates the exchange of two elements: integrates Lambert's form factor to the larger element over the smaller
/// element by Gaussian quadrature. A line of sight is free if rays from both ends hit the other element first, apart
/// from panes. Thread-safe.
class ExchangeEstimator {
  public:
    ExchangeEstimator(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, std::uint64_t seed)
        : forest_(forest), ray_caster_(ray_caster), panes_(scene, ray_caster), seed_(seed) {}

    /// Returns whether each element extends above the plane of the other by more than rounding errors.
    bool face_each_other(const ElementPair& pair) const;

    /// @param rays  Increased by the number of traced rays.
    Exchange estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const;

    /// Returns the transmittance of the panes between two points; 0 if another surface hides one from the other.
    /// @param rays  Increased by the number of traced rays.
    Rgb transmittance(const PointOfElement& x, const PointOfElement& y, std::int64_t& rays) const;

  private:
    Rgb one_way(const PointOfElement& from, const PointOfElement& to, std::int64_t& rays) const;

    const ElementForest& forest_;
    const RayCaster& ray_caster_;
    Panes panes_;
    std::uint64_t seed_;
};

}  // namespace interflect::detail
