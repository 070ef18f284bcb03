#include "interflect/raycast/panes.h"

#include <algorithm>

#include "interflect/geometry/patch_geometry.h"

namespace interflect::inline detail {

Panes::Panes(const Scene& scene, const RayCaster& ray_caster)
    : scene_(scene),
      ray_caster_(ray_caster),
      any_(std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return largest_channel(m.transmittance) > 0; })) {}

Ray Panes::behind(const Ray& ray, const Hit& hit) const {
    const PatchGeometry geometry(scene_, scene_.patches[hit.patch]);
    const V3f x = geometry.point(geometry.parameters_of(ray.origin + hit.distance * ray.direction));
    return {x - geometry.normal() * ray_caster_.ray_offset(hit.patch), ray.direction};
}

void Panes::trace(std::span<const Ray> rays, std::span<const Hit> hits, std::vector<HitBehind>& behind) const {
    behind.clear();
    if (!any_) return;
    for (std::uint32_t i = 0; i < rays.size(); ++i)
        if (has(hits[i].patch)) behind.push_back({i, Rgb(1), hits[i]});
    std::vector<Ray> rest;
    std::vector<Hit> found;
    std::size_t first = 0;  // of those that the last round has found
    const std::size_t panes_hit = behind.size();
    for (int round = 0; round < most_in_a_row && first < behind.size(); ++round) {
        const std::size_t end = behind.size();
        std::vector<std::size_t> passed;
        rest.clear();
        for (std::size_t k = first; k < end; ++k) {
            if (!has(behind[k].hit.patch)) continue;
            passed.push_back(k);
            rest.push_back(this->behind(rays[behind[k].ray], behind[k].hit));
        }
        found.resize(rest.size());
        ray_caster_.trace(rest, found);
        for (std::size_t k = 0; k < passed.size(); ++k) {
            const HitBehind before = behind[passed[k]];
            const Ray& ray = rays[before.ray];
            Hit hit = found[k];
            hit.distance += (rest[k].origin - ray.origin).dot(ray.direction);
            behind.push_back({before.ray, before.transmittance * transmittance(before.hit.patch), hit});
        }
        first = end;
    }
    behind.erase(behind.begin(), behind.begin() + static_cast<std::ptrdiff_t>(panes_hit));
    std::stable_sort(behind.begin(), behind.end(), [](const auto& a, const auto& b) { return a.ray < b.ray; });
}

}  // namespace interflect::inline detail
