#include "interflect/render/rays/path_rays.h"

#include <span>

#include "interflect/core.h"
#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect::detail {

namespace {

/// Paths of smaller throughput end. Otherwise, opposite mirrors that are also panes would double the number of paths at
/// each reflection.
constexpr float min_throughput = 1e-3f;

Rgb reflectance_of_hit(const TracedScene& scene, const Ray& ray, const Hit& hit) {
    const Parameters p = scene.geometry[hit.patch].parameters_of(ray.origin + hit.distance * ray.direction);
    return reflectance_at(scene.scene, scene.scene.patches[hit.patch], p);
}

/// Adds the path behind the pane that path i hit, and the path that the surface mirrors.
void split(const TracedScene& scene, bool has_mirrors, PathRays& paths, std::size_t i) {
    const Hit hit = paths.hits[i];
    if (hit.patch == none) return;
    const Ray ray = paths.rays[i];
    const auto add = [&](const Ray& next, const Rgb& share) {
        Path path = paths.paths[i];
        path.throughput *= share;
        path.travelled += hit.distance;
        path.sets_first_hit &= largest_channel(reflectance_of_hit(scene, ray, hit)) <= 0;
        if (largest_channel(path.throughput) >= min_throughput) paths.add(path, next);
    };
    const Rgb through = scene.panes.transmittance(ray, hit);
    if (largest_channel(through) > 0) add(scene.panes.behind(ray, hit), through);
    const Rgb& mirrored = scene.material(hit.patch).specular_reflectance;
    if (!has_mirrors || largest_channel(mirrored) <= 0) return;
    const V3f n = scene.geometry[hit.patch].normal();
    add({scene.lifted(hit.patch, ray.origin + hit.distance * ray.direction),
         ray.direction - 2 * n.dot(ray.direction) * n},
        mirrored);
}

}  // namespace

void find_surfaces(const TracedScene& scene, bool splits, bool has_mirrors, PathRays& paths, RayCounts& counts) {
    constexpr int max_splits = Panes::max_consecutive_panes;
    paths.hits.resize(paths.rays.size());
    scene.ray_caster.trace(paths.rays, paths.hits);
    std::size_t first = 0;
    for (int round = 0; splits && round < max_splits && first < paths.rays.size(); ++round) {
        const std::size_t end = paths.rays.size();
        for (std::size_t i = first; i < end; ++i) split(scene, has_mirrors, paths, i);
        paths.hits.resize(paths.rays.size());
        scene.ray_caster.trace(std::span(paths.rays).subspan(end), std::span(paths.hits).subspan(end));
        first = end;
    }
    counts.rays += static_cast<std::int64_t>(paths.rays.size());
}

}  // namespace interflect::detail
