#include "interflect/render/rays/traced_scene.h"

#include <algorithm>

#include "interflect/geometry/surfaces/smooth_surfaces.h"

namespace interflect::detail {

namespace {

std::vector<PatchGeometry> geometry_of(const Scene& scene) {
    std::vector<PatchGeometry> geometry;
    geometry.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) geometry.emplace_back(scene, patch);
    return geometry;
}

bool mirrors_anything(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return largest_channel(m.specular_reflectance) > 0; });
}

}  // namespace

TracedScene::TracedScene(const Scene& s, const RayCaster& caster)
    : scene(s),
      ray_caster(caster),
      geometry(geometry_of(s)),
      sources(s, geometry),
      unoccluded_light(s, geometry),
      panes(s, caster),
      has_mirrors(mirrors_anything(s)) {
    if (!s.normals.empty()) smooth_normals.emplace(s, find_smooth_surfaces(s));
}

}  // namespace interflect::detail
