#include "interflect/solver/light/materials.h"

#include <algorithm>
#include <utility>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/summary.h"

namespace interflect::detail {

namespace {

bool emits(const Material& material) { return channel_sum(material.exitance) > 0; }

std::vector<float> uncovered_shares(const Scene& scene, const RayCaster& ray_caster) {
    std::vector<float> shares;
    if (!ray_caster.has_covered_patches()) return shares;
    shares.reserve(scene.patches.size());
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) shares.push_back(ray_caster.uncovered_share(i));
    return shares;
}

}  // namespace

Materials::Materials(const Scene& scene, const RayCaster& ray_caster)
    : Materials(scene, uncovered_shares(scene, ray_caster)) {}

Materials::Materials(const Scene& scene, std::vector<float> exitance_share)
    : scene_(&scene),
      has_panes_(std::any_of(scene.materials.begin(), scene.materials.end(),
                             [](const Material& m) { return largest_channel(m.transmittance) > 0; })),
      elements_(scene, exitance_share) {
    if (exitance_share.empty() && elements_.empty()) return;
    constexpr std::size_t patches_per_task = 64;
    std::vector<PatchIndex> patches;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Material& material = scene.materials[scene.patches[i].material];
        const bool is_reduced = !exitance_share.empty() && exitance_share[i] != 1 && emits(material);
        if (is_reduced || material.is_textured()) patches.push_back(i);
    }
    if (patches.empty()) return;
    has_own_ = RankedBits(scene.patches.size(), patches);
    own_materials_.resize(patches.size());
    parallel_for_ranges(patches.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Patch& patch = scene.patches[patches[i]];
            Material& own = own_materials_[i] = scene.materials[patch.material];
            if (own.is_textured()) {
                const MeanSurface mean = elements_.of_patch(patches[i], PatchGeometry(scene, patch));
                own.reflectance = mean.reflectance;
                own.exitance = mean.exitance;
                own.transmittance = mean.transmittance;
            } else {
                own.exitance *= exitance_share[patches[i]];
            }
        }
    });
}

std::vector<Rgb> radiosity(const Materials& materials, const ElementForest& forest,
                           const std::vector<Rgb>& irradiance) {
    std::vector<Rgb> b(irradiance.size());
    for (ElementIndex e{0}; e < b.size(); ++e) {
        const MeanSurface surface = materials.surface(forest.patch(e), e);
        b[e] = surface.exitance + surface.reflectance * irradiance[e];
    }
    if (materials.has_textures()) pull(forest, b);
    return b;
}

RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values) {
    RgbD sum(0, 0, 0);
    for (ElementIndex e{0}; e < forest.patch_count(); ++e) sum += RgbD(values[e]) * static_cast<double>(forest.area(e));
    return sum;
}

}  // namespace interflect::detail

namespace interflect {

CoveredEmission covered_emission(const Scene& scene, const RayCaster& ray_caster) {
    ray_caster.require_made_for(scene);
    CoveredEmission covered;
    if (!ray_caster.has_covered_patches()) return covered;
    const detail::Materials materials(scene);
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const float share = ray_caster.uncovered_share(i);
        const Material& material = materials.material(i);
        if (share == 1 || !detail::emits(material)) continue;
        ++(share > 0 ? covered.partly : covered.wholly);
        covered.power +=
            RgbD(material.exitance) * static_cast<double>((1 - share) * patch_area(scene, scene.patches[i]));
    }
    return covered;
}

}  // namespace interflect
