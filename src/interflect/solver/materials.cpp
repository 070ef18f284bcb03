#include "interflect/solver/materials.h"

#include "interflect/geometry/patch_geometry.h"

namespace interflect {

namespace {

bool emits(const Material& material) { return channel_sum(material.exitance) > 0; }

}  // namespace

Materials::Materials(const Scene& scene, const RayCaster& ray_caster) : scene_(&scene) {
    if (!ray_caster.has_covered_patches()) return;
    std::vector<std::uint32_t> patches;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const float share = ray_caster.uncovered_share(i);
        const Material& material = scene.materials[scene.patches[i].material];
        if (share == 1 || !emits(material)) continue;
        patches.push_back(i);
        reduced_materials_.push_back(material);
        reduced_materials_.back().exitance *= share;
    }
    if (!patches.empty()) reduced_ = RankedBits(scene.patches.size(), patches);
}

CoveredEmission covered_emission(const Scene& scene, const RayCaster& ray_caster) {
    ray_caster.require_made_for(scene);
    CoveredEmission covered;
    if (!ray_caster.has_covered_patches()) return covered;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const float share = ray_caster.uncovered_share(i);
        const Material& material = scene.materials[scene.patches[i].material];
        if (share == 1 || !emits(material)) continue;
        ++(share > 0 ? covered.partly : covered.wholly);
        covered.power +=
            RgbD(material.exitance) * static_cast<double>((1 - share) * patch_area(scene, scene.patches[i]));
    }
    return covered;
}

std::vector<Rgb> radiosity(const Materials& materials, const ElementForest& forest,
                           const std::vector<Rgb>& irradiance) {
    std::vector<Rgb> b(irradiance.size());
    for (std::uint32_t e = 0; e < b.size(); ++e) {
        const std::uint32_t patch = forest.patch(e);
        b[e] = materials.exitance(patch) + materials.reflectance(patch) * irradiance[e];
    }
    return b;
}

RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values) {
    RgbD sum(0, 0, 0);
    for (std::uint32_t e = 0; e < forest.patch_count(); ++e)
        sum += RgbD(values[e]) * static_cast<double>(forest.area(e));
    return sum;
}

}  // namespace interflect
