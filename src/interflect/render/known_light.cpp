#include "interflect/render/known_light.h"

#include <algorithm>
#include <numbers>

#include "interflect/geometry/texture_mapping.h"

namespace interflect::detail {

namespace {

/// Negative irradiance (noise) is not sampled.
std::vector<float> received_power(const ElementForest& forest, std::span<const Rgb> irradiance) {
    std::vector<float> power(forest.size(), 0.0f);
    for (std::uint32_t e = 0; e < forest.size(); ++e)
        if (forest.is_leaf(e)) power[e] = std::max(0.0f, channel_sum(irradiance[e])) * forest.area(e);
    forest.for_siblings_from_leaves([&](std::uint32_t first) {
        power[forest.parent(first)] = power[first] + power[first + 1] + power[first + 2] + power[first + 3];
    });
    return power;
}

std::vector<float> reflected_power(const Scene& scene, std::span<const float> received) {
    std::vector<float> power(scene.patches.size());
    for (std::size_t i = 0; i < power.size(); ++i)
        power[i] = received[i] * channel_sum(scene.materials[scene.patches[i].material].reflectance);
    return power;
}

}  // namespace

KnownLight::KnownLight(const Scene& scene, std::span<const PatchGeometry> geometry, const ElementForest& forest,
                       std::span<const Rgb> irradiance)
    : scene_(scene),
      geometry_(geometry),
      forest_(forest),
      irradiance_(irradiance),
      received_(received_power(forest, irradiance)),
      tree_(patch_lights(scene, geometry, reflected_power(scene, received_)), scene.patches.size()) {}

KnownLight::Place KnownLight::place(std::uint32_t patch, const V3f& x) const {
    const Parameters p = geometry_[patch].parameters_of(x);
    return {patch, forest_.is_leaf(patch) ? patch : forest_.leaf_at(patch, p), p};
}

Rgb KnownLight::reflected_radiance(const Place& place) const {
    return reflectance_at(scene_, scene_.patches[place.patch], place.parameters) * irradiance_[place.leaf] /
           std::numbers::pi_v<float>;
}

KnownLight::Place KnownLight::sample(const V3f& x, const V3f& n, double uniform, float u, float v) const {
    constexpr float below_one = 1 - 0x1p-24f;
    const std::uint32_t patch = tree_.choose(x, n, uniform).index;
    if (patch == none) return {};
    const PatchGeometry& geometry = geometry_[patch];
    std::uint32_t e = patch;
    Cell cell;
    while (!forest_.is_leaf(e)) {
        const std::uint32_t children = forest_.first_child(e);
        float rest = u * received_[e];
        unsigned k = 0;
        while (k < 3 && rest >= received_[children + k]) rest -= received_[children + k++];
        while (k > 0 && !(received_[children + k] > 0)) --k;  // rounding can select an empty child
        e = children + k;
        u = std::clamp(rest / received_[e], 0.0f, below_one);  // uniform again
        cell = cell.child(k, geometry.is_triangle());
    }
    return {patch, e, geometry.uniform_parameters(u, v, {cell.u, cell.v}, cell.size)};
}

float KnownLight::density(const Place& place, const V3f& x, const V3f& n) const {
    const float all = received_[place.patch];
    if (!(all > 0)) return 0;
    return tree_.probability(place.patch, x, n) * (received_[place.leaf] / all) / forest_.area(place.leaf);
}

}  // namespace interflect::detail
