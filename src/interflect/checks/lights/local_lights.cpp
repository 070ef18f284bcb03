#include "interflect/checks/lights/local_lights.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "interflect/luminaires/emission.h"

namespace interflect::detail {

namespace {

constexpr std::size_t max_lights = 1024;
constexpr std::uint64_t seed_of_light = 31;

/// Distances of ray origins from a luminous opening, relative to the largest coordinate. Emission may start beyond a
/// close ceiling; checks start closer, at 16 roundings.
constexpr float start_offset = 0x1p-17f, checked_offset = 0x1p-20f;

bool is_local(const Luminaire& luminaire) {
    return std::holds_alternative<PointLight>(luminaire.kind) || std::holds_alternative<SpotLight>(luminaire.kind) ||
           std::holds_alternative<MeasuredLight>(luminaire.kind);
}

struct Pose {
    V3f position, direction{0, 0, 0};
};
Pose pose_of(const Luminaire& luminaire) {
    if (const auto* point = std::get_if<PointLight>(&luminaire.kind)) return {point->position};
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind))
        return {spot->position, spot->direction.normalized()};
    const auto& measured = std::get<MeasuredLight>(luminaire.kind);
    return {measured.position, measured.direction.normalized()};
}

/// Returns a scene with at most max_lights of the lights, and a triangle with the scene's bounding box.
Scene sample_of_lights(const Scene& scene) {
    Imath::Box3f box;
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k) box.extendBy(scene.vertices[patch.vertices[k]]);
    Scene sample;
    sample.vertices = {box.min, {box.max.x, box.min.y, box.min.z}, box.max};
    sample.patches.push_back({{0, 1, 2, none}});
    std::vector<const Luminaire*> lights;
    for (const Luminaire& luminaire : scene.luminaires)
        if (is_local(luminaire) && largest_channel(rating(luminaire)) > 0) lights.push_back(&luminaire);
    const std::size_t step = (lights.size() + max_lights - 1) / max_lights;
    for (std::size_t i = 0; i < lights.size(); i += step) sample.luminaires.push_back(*lights[i]);
    return sample;
}

float reach_of(const Scene& sample) {
    float reach = 0;
    for (const V3f& x : sample.vertices)
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(x[k]));
    return reach;
}

}  // namespace

LocalLights::LocalLights(const Scene& scene) {
    constexpr std::size_t rays_per_part = rays_per_light / Emission::parts_per_emitter;
    Scene sample = sample_of_lights(scene);
    reach_ = reach_of(sample);
    rays_.resize(sample.luminaires.size() * rays_per_light);
    const Emission emission(sample);
    const float back = (start_offset - checked_offset) * reach_;
    PointBlock points;
    for (std::size_t part = 0; part < emission.part_count(); ++part) {
        const std::size_t light = emission.luminaire(part), first = part % Emission::parts_per_emitter * rays_per_part;
        const std::span<Ray> rays(rays_.data() + light * rays_per_light + first, rays_per_part);
        emission.shoot(part, PointSet::random, seed_of_light, part * rays_per_part, points, rays);
        if (std::holds_alternative<MeasuredLight>(sample.luminaires[light].kind))
            for (Ray& ray : rays) ray.origin -= back * ray.direction;
    }
    luminaires_ = std::move(sample.luminaires);
}

V3f LocalLights::position(std::size_t i) const { return pose_of(luminaires_[i]).position; }

V3f LocalLights::in_front_of(std::size_t i) const {
    const Pose pose = pose_of(luminaires_[i]);
    return pose.position + start_offset * reach_ * pose.direction;
}

}  // namespace interflect::detail
