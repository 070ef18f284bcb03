#include "apps/interflect/report/facts.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include "interflect/luminaires/emission.h"
#include "interflect/scene/faces/patch_area.h"
#include "interflect/solver/light/materials.h"

namespace interflect::command {

using namespace detail;

namespace {

double photometric(const Rgb& colour) { return luminance(RgbD(colour)); }

std::vector<SurfaceFacts> surfaces_of(const Scene& scene, const Materials& materials) {
    std::map<std::uint32_t, SurfaceFacts> surfaces;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side < i) continue;
        SurfaceFacts& s = surfaces[patch.material];
        const double area = patch_area(scene, patch);
        s.area += area;
        s.reflectance += area * photometric(materials.reflectance(i));
    }
    std::vector<SurfaceFacts> sorted;
    for (auto& [material, s] : surfaces) {
        s.material = scene.materials[material].name;
        s.reflectance /= s.area;
        s.transmittance = photometric(scene.materials[material].transmittance);
        s.specular_reflectance = photometric(scene.materials[material].specular_reflectance);
        sorted.push_back(s);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const SurfaceFacts& a, const SurfaceFacts& b) { return a.area > b.area; });
    return sorted;
}

void add_emitting_surfaces(const Scene& scene, const Materials& materials, std::vector<LightFacts>& lights) {
    std::map<std::uint32_t, LightFacts> by_material;
    std::map<std::uint32_t, std::set<std::uint32_t>> objects;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        const double exitance = photometric(materials.exitance(i));
        if (!(exitance > 0)) continue;
        LightFacts& light = by_material[patch.material];
        light.flux += exitance * static_cast<double>(patch_area(scene, patch));
        objects[patch.material].insert(patch.object);
    }
    for (auto& [material, light] : by_material) {
        const Material& m = scene.materials[material];
        light.name = m.name;
        light.kind = "surface";
        light.count = objects[material].size();
        if (m.exitance_texture == none) light.luminance = photometric(m.exitance) / std::numbers::pi;
        lights.push_back(light);
    }
}

bool is_far_away(const Luminaire& luminaire) {
    return !std::holds_alternative<PointLight>(luminaire.kind) && !std::holds_alternative<SpotLight>(luminaire.kind) &&
           !std::holds_alternative<MeasuredLight>(luminaire.kind);
}

/// Adds one entry per photometric file or kind of unmeasured light.
void add_luminaires(const Scene& scene, std::vector<LightFacts>& lights) {
    const Emission emission(scene);
    std::vector<double> flux(scene.luminaires.size());
    for (std::size_t part = 0; part < emission.part_count(); ++part)
        flux[emission.luminaire(part)] += luminance(emission.power(part));
    std::map<std::string, LightFacts> by_name;
    for (std::size_t i = 0; i < flux.size(); ++i) {
        const Luminaire& luminaire = scene.luminaires[i];
        const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind);
        const std::string name = measured ? std::filesystem::path(measured->web->name).filename().string()
                                          : std::string(kind_name(luminaire)) + " light";
        LightFacts& light = by_name[name];
        light.name = name;
        light.kind = kind_name(luminaire);
        ++light.count;
        light.flux += flux[i];
        light.far_away = is_far_away(luminaire);
        if (std::holds_alternative<UniformSky>(luminaire.kind)) light.luminance = photometric(rating(luminaire));
    }
    for (const auto& [name, light] : by_name) lights.push_back(light);
}

}  // namespace

SceneFacts facts_of(const SolvedScene& solved, const RayCaster& ray_caster) {
    const Scene& scene = solved.scene;
    const Materials materials(scene, ray_caster);
    SceneFacts facts;
    for (const Patch& patch : scene.patches)
        for (std::size_t k = 0; k < static_cast<std::size_t>(patch.vertex_count()); ++k)
            facts.bounds.extendBy(scene.origin + Imath::V3d(scene.vertices[patch.vertices[k]]));
    facts.surfaces = surfaces_of(scene, materials);
    add_emitting_surfaces(scene, materials, facts.lights);
    add_luminaires(scene, facts.lights);
    std::stable_sort(facts.lights.begin(), facts.lights.end(),
                     [](const LightFacts& a, const LightFacts& b) { return a.flux > b.flux; });
    facts.balance = power_balance(scene, solved.solution);
    return facts;
}

}  // namespace interflect::command
