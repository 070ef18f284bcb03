#include "interflect/render/reflections/known_light.h"

#include <algorithm>
#include <numbers>

#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect::detail {

KnownLight::KnownLight(const Scene& scene, std::span<const PatchGeometry> geometry, const KnownIrradiance& known)
    : scene_(scene),
      geometry_(geometry),
      forest_(known.forest),
      irradiance_(known.irradiance),
      unreduced_(known.unreduced),
      excess_(forest_.size()),
      tree_({}, 0) {}

void KnownLight::sample_brighter_than(float radiosity) {
    excess_.assign(forest_.size(), 0.0f);
    for (ElementIndex e{0}; e < forest_.size(); ++e) {
        if (!forest_.is_leaf(e)) continue;
        const Rgb& reflectance = scene_.materials[scene_.patches[forest_.patch(e)].material].reflectance;
        excess_[e] = std::max(0.0f, channel_sum(reflectance * unreduced_[e]) - radiosity) * forest_.area(e);
    }
    forest_.for_siblings_from_leaves([&](ElementIndex first) {
        excess_[forest_.parent(first)] = excess_[first] + excess_[first + 1] + excess_[first + 2] + excess_[first + 3];
    });
    power_.assign(excess_.begin(), excess_.begin() + static_cast<std::ptrdiff_t>(scene_.patches.size()));
    tree_ = LightTree(patch_lights(scene_, geometry_, power_), scene_.patches.size());
}

void KnownLight::weigh(std::span<const float> weights) {
    for (std::size_t i = 0; i < power_.size(); ++i) power_[i] *= weights[i];
    tree_ = LightTree(patch_lights(scene_, geometry_, power_), scene_.patches.size());
}

KnownLight::Place KnownLight::place(PatchIndex patch, const V3f& x) const {
    const Parameters p = geometry_[patch].parameters_of(x);
    return {patch, forest_.is_leaf(patch) ? ElementIndex(patch) : forest_.leaf_at(patch, p), p};
}

Rgb KnownLight::reflected_radiance(const Place& place) const {
    return reflectance_at(scene_, scene_.patches[place.patch], place.parameters) * unreduced_[place.leaf] /
           std::numbers::pi_v<float>;
}

KnownLight::Sample KnownLight::sample(const V3f& x, const V3f& n, double choice, float u, float v) const {
    constexpr float below_one = 1 - 0x1p-24f;
    const auto [light, probability] = tree_.choose(x, n, choice);
    if (light == none) return {};
    const PatchIndex patch(light);
    const PatchGeometry& geometry = geometry_[patch];
    ElementIndex e = patch;
    Cell cell;
    while (!forest_.is_leaf(e)) {
        const ElementIndex children = forest_.first_child(e);
        float rest = u * excess_[e];
        unsigned k = 0;
        while (k < 3 && rest >= excess_[children + k]) rest -= excess_[children + k++];
        while (k > 0 && !(excess_[children + k] > 0)) --k;  // rounding can select an empty child
        e = children + k;
        u = std::clamp(rest / excess_[e], 0.0f, below_one);  // uniform in the child
        cell = cell.child(k, geometry.is_triangle());
    }
    const Place place{patch, e, geometry.uniform_parameters(u, v, {cell.u, cell.v}, cell.size)};
    return {place, probability * density_in_patch(place)};
}

float KnownLight::density(const Place& place, const V3f& x, const V3f& n) const {
    if (!(excess_[place.leaf] > 0)) return 0;
    return tree_.probability(place.patch, x, n) * density_in_patch(place);
}

}  // namespace interflect::detail
