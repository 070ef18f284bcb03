#pragma once

#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"
#include "interflect/scene.h"
#include "interflect/solve_options.h"

namespace interflect::detail {

/// Importance of surfaces for the views, from the hit points of camera rays that are stratified over the pictures.
class ViewImportance {
  public:
    ViewImportance(std::span<const WeightedView> views, std::uint64_t seed)
        : views_(views.begin(), views.end()), seed_(seed) {}

    void trace_view_rays(const ElementForest& forest, const RayCaster& ray_caster, const Panes& panes,
                         int rays_per_view);

    bool empty() const { return points_.empty(); }  ///< Whether no view shows a surface.
    std::int64_t rays() const { return rays_; }     ///< Number of rays that were requested for all views.
    std::int64_t views() const { return std::ssize(views_); }
    /// Returns the share of the pictures that shows surfaces.
    double surface_share() const { return total_weight_ > 0 ? hit_weight_ / total_weight_ : 0; }
    /// Computes v = V / A by element [1/m^2] (docs/method/method.md, Unknowns). Surfaces behind panes add their
    /// transmitted share of V.
    /// @param at_patches  Whether V is spread evenly over each patch.
    std::vector<float> per_area(const ElementForest& forest, bool at_patches);

    /// Resets lookups that refer to elements from `size` on. Call before these elements are removed.
    void shrink(std::uint32_t size);

    void archive(StateArchive& archive);
    /// Returns whether restored data are consistent with the forest.
    bool is_consistent(const ElementForest& forest) const;

  private:
    void add_points_behind(const ElementForest& forest, const Panes& panes, std::span<const Ray> rays,
                           std::span<const Hit> hits, float share);

    struct Point {
        PatchIndex patch;
        Parameters parameters;
        float share;        // share of all pictures, times total_weight_
        ElementIndex leaf;  // result of the last lookup
    };
    std::vector<WeightedView> views_;
    std::uint64_t seed_;
    std::uint64_t rounds_ = 0;
    std::int64_t rays_ = 0;
    double total_weight_ = 0;  // sum of the weights of all camera rays
    double hit_weight_ = 0;    // sum of the weights of camera rays that hit a surface
    std::vector<Point> points_;
};

}  // namespace interflect::detail
