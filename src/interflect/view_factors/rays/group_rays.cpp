#include "interflect/view_factors/rays/group_rays.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/scene/faces/patch_area.h"

namespace interflect::detail {

namespace {

double exact_area(const Scene& scene, const Patch& patch) {
    std::array<Imath::V3d, 4> corners;
    const auto count = static_cast<std::size_t>(patch.vertex_count());
    for (std::size_t c = 0; c < count; ++c) corners[c] = Imath::V3d(scene.vertices[patch.vertices[c]]);
    return doubled_area_vector(std::span<const Imath::V3d>(corners).first(count)).length() / 2;
}

}  // namespace

GroupRays::GroupRays(const Scene& scene, const RayCaster& ray_caster, const FaceGroup& group)
    : ray_caster_(ray_caster) {
    double area_with_covered = 0;
    sources_.reserve(group.patches.size());
    for (const PatchIndex p : group.patches) {
        const double share = ray_caster.uncovered_share(p);
        if (share == 0) continue;
        const double area = exact_area(scene, scene.patches[p]);
        area_ += share * area;
        area_with_covered += area;
        has_covered_parts_ = has_covered_parts_ || share < 1;
        sources_.push_back({PatchGeometry(scene, scene.patches[p]), p, ray_caster.ray_offset(p), area_with_covered});
    }
}

void GroupRays::make(std::uint64_t key, std::uint64_t first, std::size_t count, Batch& batch) const {
    assert(!sources_.empty());
    fill_points(PointSet::sobol, key, first, count, batch.points);
    const auto& [a, b, c, d] = batch.points.coordinate;
    batch.rays.resize(count);
    batch.sources.resize(count);
    const double total_area = sources_.back().area_up_to_here;
    for (std::size_t i = 0; i < count; ++i) {
        // The first coordinate selects the patch; the rest of it is uniform again.
        const double area = a[i] * total_area;
        const auto source = std::upper_bound(sources_.begin(), sources_.end() - 1, area,
                                             [](double x, const Source& s) { return x < s.area_up_to_here; });
        const double before = source == sources_.begin() ? 0 : std::prev(source)->area_up_to_here;
        const auto rest = static_cast<float>((area - before) / (source->area_up_to_here - before));
        const PatchGeometry& geometry = source->geometry;
        const V3f normal = geometry.normal();
        const TangentFrame frame(normal);
        const float radius = std::sqrt(c[i]), turn = 2 * std::numbers::pi_v<float> * d[i];  // Malley's method
        batch.rays[i] = {
            geometry.point(geometry.uniform_parameters(std::clamp(rest, 0.0f, 1.0f), b[i])) + normal * source->offset,
            frame.s * (radius * std::cos(turn)) + frame.t * (radius * std::sin(turn)) + normal * std::sqrt(1 - c[i])};
        batch.sources[i] = static_cast<std::uint32_t>(source - sources_.begin());
    }
    if (has_covered_parts_) drop_covered_starts(batch);
}

void GroupRays::drop_covered_starts(Batch& batch) const {
    // The ray back to the start hits the coincident face that intercepts rays there.
    batch.probes.resize(batch.rays.size());
    batch.hits.resize(batch.rays.size());
    for (std::size_t i = 0; i < batch.rays.size(); ++i)
        batch.probes[i] = {batch.rays[i].origin, -sources_[batch.sources[i]].geometry.normal()};
    ray_caster_.trace(batch.probes, batch.hits);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < batch.rays.size(); ++i)
        if (batch.hits[i].patch == sources_[batch.sources[i]].patch) batch.rays[kept++] = batch.rays[i];
    batch.rays.resize(kept);
}

}  // namespace interflect::detail
