#include "interflect/solver/view_importance.h"

#include <algorithm>
#include <cmath>

#include "interflect/base/random.h"
#include "interflect/raycast/camera.h"

namespace interflect {

namespace {

/// One jittered ray through each cell of a grid over the picture, about `rays` of them.
std::vector<Ray> eye_rays(const WeightedView& w, int rays, std::uint64_t key) {
    const int rows = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(rays) / w.aspect)));
    const int columns = std::max(1, static_cast<int>(static_cast<float>(rows) * w.aspect));
    const Camera camera(w.view, columns, rows);
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

ViewImportance::ViewImportance(std::span<const WeightedView> views, const ElementForest& forest,
                               const RayCaster& ray_caster, int rays_per_view, std::uint64_t seed) {
    for (std::size_t v = 0; v < views.size(); ++v) {
        const std::vector<Ray> rays = eye_rays(views[v], rays_per_view, mix(seed, v));
        std::vector<Hit> hits(rays.size());
        ray_caster.trace(rays, hits);
        for (std::size_t r = 0; r < rays.size(); ++r) {
            if (hits[r].patch == none) continue;
            const V3f y = rays[r].origin + hits[r].distance * rays[r].direction;
            points_.push_back({hits[r].patch, forest.geometry(hits[r].patch).parameters_of(y),
                               static_cast<float>(views[v].weight / static_cast<double>(rays.size()))});
        }
    }
    double sum = 0;
    for (const Point& p : points_) sum += p.share;
    for (Point& p : points_) p.share = static_cast<float>(p.share / sum);
}

std::vector<float> ViewImportance::per_area(const ElementForest& forest, bool at_patches) const {
    std::vector<float> v(forest.size(), 0.0f);
    for (const Point& p : points_) v[at_patches ? p.patch : forest.leaf_at(p.patch, p.parameters)] += p.share;
    for (std::uint32_t e = 0; e < forest.size(); ++e) v[e] /= forest.area(e);
    push(forest, v);
    pull(forest, v);
    return v;
}

}  // namespace interflect
