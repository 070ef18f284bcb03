#include "interflect/raycast/panes.h"

#include <algorithm>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect::detail {

Panes::Panes(const Scene& scene, const RayCaster& ray_caster)
    : scene_(scene),
      ray_caster_(ray_caster),
      any_(std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return largest_channel(m.transmittance) > 0; })) {}

Rgb Panes::transmittance(const Ray& ray, const Hit& hit) const {
    if (!any_ || hit.patch == none) return Rgb(0);
    const Patch& patch = scene_.patches[hit.patch];
    const Material& material = scene_.materials[patch.material];
    if (material.transmittance_texture == none) return material.transmittance;
    const V3f x = ray.origin + hit.distance * ray.direction;
    return transmittance_at(scene_, patch, PatchGeometry(scene_, patch).parameters_of(x));
}

Ray Panes::behind(const Ray& ray, const Hit& hit) const {
    const PatchGeometry geometry(scene_, scene_.patches[hit.patch]);
    const V3f x = geometry.point(geometry.parameters_of(ray.origin + hit.distance * ray.direction));
    return {x - geometry.normal() * ray_caster_.ray_offset(hit.patch), ray.direction};
}

void Panes::trace(std::span<const Ray> rays, std::span<const Hit> hits, std::vector<HitBehind>& behind) const {
    behind.clear();
    if (!any_) return;
    std::vector<HitBehind> passing;
    std::vector<Ray> rest;
    // Continues the ray behind its hit, unless the hit is opaque
    const auto pass = [&](std::uint32_t ray, const Rgb& transmittance_before, const Hit& hit) {
        const Rgb through = transmittance_before * transmittance(rays[ray], hit);
        if (!(largest_channel(through) > 0)) return;
        passing.push_back({ray, through, {}});
        rest.push_back(this->behind(rays[ray], hit));
    };
    for (std::uint32_t i = 0; i < rays.size(); ++i) pass(i, Rgb(1), hits[i]);
    std::vector<Hit> found;
    for (int round = 0; round < max_consecutive_panes && !passing.empty(); ++round) {
        found.resize(rest.size());
        ray_caster_.trace(rest, found);
        for (std::size_t k = 0; k < passing.size(); ++k) {
            const Ray& ray = rays[passing[k].ray];
            passing[k].hit = found[k];
            passing[k].hit.distance += (rest[k].origin - ray.origin).dot(ray.direction);
        }
        const std::size_t first = behind.size();
        behind.insert(behind.end(), passing.begin(), passing.end());
        passing.clear();
        rest.clear();
        for (std::size_t k = first; k < behind.size(); ++k) pass(behind[k].ray, behind[k].transmittance, behind[k].hit);
    }
    std::stable_sort(behind.begin(), behind.end(), [](const auto& a, const auto& b) { return a.ray < b.ray; });
}

}  // namespace interflect::detail
