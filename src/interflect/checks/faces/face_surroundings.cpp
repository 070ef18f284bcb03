#include "interflect/checks/faces/face_surroundings.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "interflect/base/numbers/random.h"
#include "interflect/checks/search/one_way.h"
#include "interflect/checks/search/sight_lines.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

namespace {

constexpr std::uint64_t rays_of_face = 64, paths_of_lamp = 64, reflections = 8, seed_of_surroundings = 1;
constexpr float close_by = 0.1f;  // relative to a face's size

V3f direction_around(const V3f& normal, std::uint64_t index) {
    return SightLines::cosine_direction(normal, seed_of_surroundings, index);
}

Hit first_hit(const RayCaster& ray_caster, const Ray& ray) {
    Hit hit;
    ray_caster.trace({&ray, 1}, {&hit, 1});
    return hit;
}

}  // namespace

FaceSurroundings::FaceSurroundings(const Scene& scene, const RayCaster& ray_caster)
    : scene_(scene), ray_caster_(ray_caster), scene_size_(core_bounds(scene).size().length()) {}

Surroundings FaceSurroundings::measure(PatchIndex patch, Side side) const {
    const PatchGeometry geometry(scene_, scene_.patches[patch]);
    const V3f normal = side == Side::front ? geometry.normal() : -geometry.normal();
    const float near = close_by * std::sqrt(geometry.area());
    int blocked = 0, escaped = 0, one_way = 0;
    for (std::uint64_t i = 0; i < rays_of_face; ++i) {
        const auto words = random_words(seed_of_surroundings + 1, i);
        const V3f x = geometry.point(geometry.uniform_parameters(unit_float(words[0]), unit_float(words[1])));
        const Ray ray{x + ray_caster_.ray_offset(patch) * normal, direction_around(normal, i)};
        const Hit hit = first_hit(ray_caster_, ray);
        escaped += hit.patch == none;
        blocked += hit.patch != none && hit.distance < near;
        one_way += hit.patch != none && is_one_way(scene_, ray_caster_, ray, hit);
    }
    return {static_cast<float>(blocked) / rays_of_face, static_cast<float>(escaped) / rays_of_face,
            static_cast<float>(one_way) / rays_of_face};
}

template <class Start>
bool FaceSurroundings::stays_within(float extent, const Start& start) const {
    Imath::Box3f reached;
    for (std::uint64_t path = 0; path < paths_of_lamp; ++path) {
        Ray ray = start(path);
        for (std::uint64_t k = 0; k < reflections; ++k) {
            const Hit hit = first_hit(ray_caster_, ray);
            if (hit.patch == none) return false;
            const V3f x = ray.origin + hit.distance * ray.direction;
            reached.extendBy(x);
            if (reached.size().length() > extent) return false;
            const Patch& patch = scene_.patches[hit.patch];
            const PatchGeometry geometry(scene_, patch);
            const bool is_glass = largest_channel(transmittance_at(scene_, patch, geometry.parameters_of(x))) > 0;
            const V3f out = (is_glass ? -1.0f : 1.0f) * geometry.normal();
            ray = {x + ray_caster_.ray_offset(hit.patch) * out,
                   is_glass ? ray.direction : direction_around(out, path * reflections + k)};
        }
    }
    return true;
}

bool FaceSurroundings::is_enclosed(PatchIndex patch) const {
    const PatchGeometry geometry(scene_, scene_.patches[patch]);
    const float size = std::sqrt(geometry.area());
    return stays_within(std::min(scene_size_ / 10, std::max(5 * size, 0.5f)), [&](std::uint64_t path) {
        return Ray{geometry.centre() + ray_caster_.ray_offset(patch) * geometry.normal(),
                   direction_around(geometry.normal(), path)};
    });
}

}  // namespace interflect::detail
