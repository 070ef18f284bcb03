#include "apps/interflect/report/facts.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numbers>

#include "interflect/summary.h"

namespace interflect::command {

namespace {

double photometric(const Rgb& colour) { return luminance(RgbD(colour)); }

std::vector<SurfaceFacts> surfaces_of(const Scene& scene, const SceneSummary& summary) {
    std::vector<SurfaceFacts> surfaces;
    for (const MaterialSummary& m : summary.materials) {
        const Material& material = scene.materials[m.material];
        surfaces.push_back({.material = material.name,
                            .area = m.area,
                            .reflectance = luminance(m.reflectance),
                            .transmittance = photometric(material.transmittance),
                            .specular_reflectance = photometric(material.specular_reflectance)});
    }
    std::stable_sort(surfaces.begin(), surfaces.end(),
                     [](const SurfaceFacts& a, const SurfaceFacts& b) { return a.area > b.area; });
    return surfaces;
}

void add_emitting_surfaces(const Scene& scene, const SceneSummary& summary, std::vector<LightFacts>& lights) {
    for (const MaterialSummary& m : summary.materials) {
        if (m.emitting_patches == 0) continue;
        const Material& material = scene.materials[m.material];
        LightFacts& light = lights.emplace_back();
        light.name = material.name;
        light.kind = "surface";
        light.count = m.emitting_objects;
        light.flux = luminance(m.power);
        if (material.exitance_texture == none) light.luminance = photometric(material.exitance) / std::numbers::pi;
    }
}

bool is_far_away(const Luminaire& luminaire) {
    return !std::holds_alternative<PointLight>(luminaire.kind) && !std::holds_alternative<SpotLight>(luminaire.kind) &&
           !std::holds_alternative<MeasuredLight>(luminaire.kind);
}

/// Adds one entry per photometric file or kind of unmeasured light.
void add_luminaires(const Scene& scene, const SceneSummary& summary, std::vector<LightFacts>& lights) {
    std::map<std::string, LightFacts> by_name;
    for (std::size_t i = 0; i < summary.luminaires.size(); ++i) {
        const Luminaire& luminaire = scene.luminaires[i];
        const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind);
        const std::string name = measured ? std::filesystem::path(measured->web->name).filename().string()
                                          : std::string(kind_name(luminaire)) + " light";
        LightFacts& light = by_name[name];
        light.name = name;
        light.kind = kind_name(luminaire);
        ++light.count;
        light.flux += luminance(summary.luminaires[i]);
        light.far_away = is_far_away(luminaire);
        if (std::holds_alternative<UniformSky>(luminaire.kind)) light.luminance = photometric(rating(luminaire));
    }
    for (const auto& [name, light] : by_name) lights.push_back(light);
}

}  // namespace

SceneFacts facts_of(const SolvedScene& solved, const RayCaster& ray_caster) {
    const Scene& scene = solved.scene;
    const SceneSummary summary = summarise(scene, ray_caster);
    SceneFacts facts;
    facts.bounds = summary.bounds;
    facts.surfaces = surfaces_of(scene, summary);
    add_emitting_surfaces(scene, summary, facts.lights);
    add_luminaires(scene, summary, facts.lights);
    std::stable_sort(facts.lights.begin(), facts.lights.end(),
                     [](const LightFacts& a, const LightFacts& b) { return a.flux > b.flux; });
    facts.balance = power_balance(scene, solved.solution);
    return facts;
}

}  // namespace interflect::command
