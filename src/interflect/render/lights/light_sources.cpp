#include "interflect/render/lights/light_sources.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/render/lights/patch_points.h"

namespace interflect::detail {

LightSources::LightSources(const Scene& scene, std::span<const PatchGeometry> geometry)
    : scene_(scene),
      geometry_(geometry),
      patches_(patch_lights(scene, geometry, emitted_powers(scene, geometry)), scene.patches.size()),
      luminaires_(scene),
      skies_(scene) {}

void LightSources::weigh(SourceKind kind, std::span<const float> weights) {
    if (kind == SourceKind::patches) patches_.weigh(weights);
    if (kind == SourceKind::lamps) luminaires_.weigh_lamps(weights);
}

std::uint32_t LightSources::useful_rays(SourceKind kind, std::uint32_t most) const {
    if (kind == SourceKind::patches) return patches_.light_count() > 0 ? most : 0;
    const LuminaireChoice::Group& group = kind == SourceKind::lamps ? luminaires_.lamps() : luminaires_.suns();
    return group.has_extent ? most : std::min(most, group.count);
}

SourceSample LightSources::sample(SourceKind kind, const V3f& x, const V3f& n, const LightSample& numbers) const {
    if (kind == SourceKind::patches) return sample_patch(x, n, numbers);
    const auto [luminaire, light] =
        kind == SourceKind::lamps ? luminaires_.choose_lamp(x, n, numbers) : luminaires_.choose_sun(x, n, numbers);
    return {luminaire, light.towards, no_patch, light.distance, light.irradiance, 0};
}

SourceSample LightSources::sample_patch(const V3f& x, const V3f& n, const LightSample& numbers) const {
    const LightTree::Choice choice = patches_.choose(x, n, numbers.choice);
    if (choice.index == none) return {};
    const std::optional<PatchPoint> point = detail::sample_patch(geometry_[choice.index], x, numbers.u, numbers.v);
    if (!point) return {};
    const float cosine = n.dot(point->direction), density = choice.probability * point->density;
    if (!(cosine > 0 && density > 0)) return {};
    const Rgb exitance = exitance_at(scene_, scene_.patches[choice.index], point->at);
    return {choice.index,
            point->direction,
            PatchIndex(choice.index),
            0,
            exitance * (cosine / std::numbers::pi_v<float> / density),
            density};
}

float LightSources::density(PatchIndex patch, const V3f& x, const V3f& n, const V3f& direction, float distance2) const {
    return patches_.probability(patch, x, n) * patch_density(geometry_[patch], x, direction, distance2);
}

}  // namespace interflect::detail
