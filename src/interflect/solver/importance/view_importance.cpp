#include "interflect/solver/importance/view_importance.h"

#include <algorithm>
#include <cmath>

#include "interflect/base/files/state_archive.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/camera.h"

namespace interflect::detail {

namespace {

std::vector<Ray> camera_rays(const WeightedView& w, const Imath::V3d& origin, int rays, std::uint64_t key) {
    const int rows = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(rays) / w.aspect)));
    const int columns = std::max(1, static_cast<int>(static_cast<float>(rows) * w.aspect));
    const Camera camera(w.view, columns, rows, origin);
    std::vector<Ray> result;
    result.reserve(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto words = random_words(key, result.size());
            result.push_back(
                camera.ray(static_cast<float>(i) + unit_float(words[0]), static_cast<float>(j) + unit_float(words[1])));
        }
    return result;
}

}  // namespace

void ViewImportance::add_points_behind(const ElementForest& forest, const Panes& panes, std::span<const Ray> rays,
                                       std::span<const Hit> hits, float share) {
    std::vector<Panes::HitBehind> behind;
    panes.trace(rays, hits, behind);
    for (const auto& [ray, transmittance, hit] : behind) {
        if (hit.patch == none) continue;
        const V3f y = rays[ray].origin + hit.distance * rays[ray].direction;
        points_.push_back({hit.patch, forest.geometry(hit.patch).parameters_of(y),
                           share * channel_sum(transmittance) / 3, hit.patch});
    }
}

void ViewImportance::trace_view_rays(const ElementForest& forest, const RayCaster& ray_caster, const Panes& panes,
                                     int rays_per_view) {
    constexpr std::size_t rays_per_task = 4096;
    for (std::size_t v = 0; v < views_.size(); ++v) {
        const std::vector<Ray> rays =
            camera_rays(views_[v], ray_caster.origin(), rays_per_view, mix(mix(seed_, v), rounds_));
        std::vector<Hit> hits(rays.size());
        parallel_for_ranges(rays.size(), rays_per_task, [&](std::size_t begin, std::size_t end) {
            ray_caster.trace(std::span(rays).subspan(begin, end - begin), std::span(hits).subspan(begin, end - begin));
        });
        const auto share = static_cast<float>(views_[v].weight * rays_per_view / static_cast<double>(rays.size()));
        for (std::size_t r = 0; r < rays.size(); ++r) {
            const PatchIndex patch = hits[r].patch;
            if (patch == none) continue;
            const V3f y = rays[r].origin + hits[r].distance * rays[r].direction;
            points_.push_back({patch, forest.geometry(patch).parameters_of(y), share, patch});
            hit_weight_ += static_cast<double>(share);
        }
        total_weight_ += static_cast<double>(share) * static_cast<double>(rays.size());
        add_points_behind(forest, panes, rays, hits, share);
        rays_ += rays_per_view;
    }
    ++rounds_;
}

void ViewImportance::shrink(std::uint32_t size) {
    for (Point& p : points_)
        if (p.leaf >= size) p.leaf = p.patch;
}

void ViewImportance::archive(StateArchive& archive) {
    archive("view/points", points_);
    archive("view/rounds", rounds_);
    archive("view/rays", rays_);
    archive.amounts("view/shares", total_weight_);
    archive.amounts("view/hit_shares", hit_weight_);
}

bool ViewImportance::is_consistent(const ElementForest& forest) const {
    const auto is_valid = [&](const Point& p) {
        return p.leaf < forest.size() && p.patch == forest.patch(p.leaf) && std::isfinite(p.parameters.u) &&
               std::isfinite(p.parameters.v) && std::isfinite(p.share) && p.share >= 0;
    };
    return std::all_of(points_.begin(), points_.end(), is_valid) && (points_.empty() || hit_weight_ > 0) &&
           hit_weight_ <= total_weight_;
}

std::vector<float> ViewImportance::per_area(const ElementForest& forest, bool at_patches) {
    constexpr std::size_t points_per_task = 4096;
    if (!at_patches)
        parallel_for_ranges(points_.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
            for (Point& p : std::span(points_).subspan(begin, end - begin))
                if (!forest.is_leaf(p.leaf)) p.leaf = forest.leaf_below(p.leaf, forest.cell(p.leaf), p.parameters);
        });
    std::vector<float> v(forest.size(), 0.0f);
    for (const Point& p : points_) v[at_patches ? p.patch : p.leaf] += p.share;
    const double per_share = 1 / hit_weight_;
    parallel_for_ranges(v.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (ElementIndex e(begin); e < end; ++e) v[e] = static_cast<float>(v[e] * per_share / forest.area(e));
    });
    push(forest, v);
    pull(forest, v);
    return v;
}

}  // namespace interflect::detail
