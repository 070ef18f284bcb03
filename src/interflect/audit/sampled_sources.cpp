#include "interflect/audit/sampled_sources.h"

#include <cmath>

#include "interflect/solver/light/materials.h"
#include "interflect/solver/sampling/ray_maker.h"

namespace interflect::detail {

SampledSources sample_sources(const Scene& scene, const RayCaster& ray_caster, const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    forest.require_made_for(scene);
    ray_caster.require_made_for(scene);
    Materials materials(scene, ray_caster);
    materials.grow(forest);
    const std::vector<Rgb> b = radiosity(materials, forest, solution.irradiance);
    const std::vector<ElementIndex> leaves = forest.leaves();
    std::vector<double> cumulative;
    cumulative.reserve(leaves.size());
    SampledSources result;
    for (const ElementIndex leaf : leaves) {
        const float sum = channel_sum(b[leaf]);
        if (std::isfinite(sum)) result.power += static_cast<double>(sum * forest.area(leaf));
        cumulative.push_back(result.power);
    }
    std::size_t i = 0;
    for (std::int64_t k = 0; result.power > 0 && k < audit_rays; ++k) {
        const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(audit_rays) * result.power;
        while (cumulative[i] < at) ++i;
        result.leaves.push_back(leaves[i]);
    }
    return result;
}

Ray ray_from(ElementIndex leaf, const ElementForest& forest, const RayCaster& ray_caster, std::uint64_t sample,
             PointBlock& points) {
    const PatchIndex patch = forest.patch(leaf);
    Ray ray;
    Parameters origin;
    shoot_rays(forest.geometry(patch), forest.cell(leaf), ray_caster.ray_offset(patch), PointSet::random, audit_seed,
               sample, points, {&ray, 1}, {&origin, 1});
    return ray;
}

}  // namespace interflect::detail
