#include "interflect/checks/search/one_way.h"

#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

bool is_one_way(const Scene& scene, const RayCaster& ray_caster, const Ray& ray, const Hit& hit) {
    constexpr float rounding = 1e-4f, offsets = 8;  // tolerances of the distance: relative, and in ray offsets
    const float offset = ray_caster.ray_offset(hit.patch);
    const V3f normal = PatchGeometry(scene, scene.patches[hit.patch]).normal();
    const Ray reversed{ray.origin + hit.distance * ray.direction + offset * normal, -ray.direction};
    Hit back;
    ray_caster.trace({&reversed, 1}, {&back, 1});
    return back.patch != none && back.distance < hit.distance * (1 - rounding) - offsets * offset;
}

}  // namespace interflect::detail
