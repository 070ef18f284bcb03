#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// A view and how much it counts beside others.
struct WeightedView {
    View view = {};
    double weight = 1;         ///< > 0; what counts is its share of the sum of all.
    float aspect = 16.0f / 9;  ///< Width over height of the picture.
};

/// Where eyes look: the points that eye rays hit, spread evenly over the picture. Kept as points, so that they can be
/// handed to elements anew whenever the mesh has changed.
class ViewImportance {
  public:
    /// @param rays_per_view  Jittered eye rays, one to a cell of the picture plane; about this many.
    ViewImportance(std::span<const WeightedView> views, const ElementForest& forest, const RayCaster& ray_caster,
                   int rays_per_view, std::uint64_t seed);

    bool empty() const { return points_.empty(); }
    /// v = V / A of every element [1/m^2]: V is the share of the picture through which an eye sees the element,
    /// weighted over the views; sum of V over what all views hit = 1. Inner elements have the mean of their children.
    /// @param at_patches  Spread each patch's V evenly over it.
    std::vector<float> per_area(const ElementForest& forest, bool at_patches) const;

  private:
    struct Point {
        std::uint32_t patch;
        Parameters parameters;
        float share;  // of all pictures
    };
    std::vector<Point> points_;
};

}  // namespace interflect
