#include <map>
#include <set>

#include "interflect/luminaires/emission.h"
#include "interflect/solver/light/materials.h"
#include "interflect/summary.h"

namespace interflect {

using namespace detail;

namespace {

/// Indices of the objects with an emitting patch of each material.
using EmittingObjects = std::map<std::uint32_t, std::set<std::uint32_t>>;

void add_shape(const Scene& scene, const Patch& patch, SceneSummary& summary) {
    for (int k = 0; k < patch.vertex_count(); ++k)
        summary.bounds.extendBy(scene.origin + Imath::V3d(scene.vertices[patch.vertices[k]]));
    summary.triangles += patch.is_triangle();
    summary.two_sided += patch.other_side != none;
}

/// Adds the area and reflectance of a face. Call it for one side of each face.
void add_face(const Scene& scene, const Materials& materials, PatchIndex i, SceneSummary& summary,
              MaterialSummary& of_material) {
    const double area = patch_area(scene, scene.patches[i]);
    summary.area += area;
    of_material.area += area;
    of_material.reflectance += RgbD(materials.reflectance(i)) * area;
}

void add_emission(const Scene& scene, const Materials& materials, PatchIndex i, SceneSummary& summary,
                  MaterialSummary& of_material) {
    const double area = patch_area(scene, scene.patches[i]);
    const RgbD power = RgbD(materials.exitance(i)) * area;
    ++of_material.emitting_patches;
    of_material.emitting_area += area;
    of_material.power += power;
    summary.emitted_power += power;
}

}  // namespace

SceneSummary summarise(const Scene& scene, const RayCaster& ray_caster) {
    ray_caster.require_made_for(scene);
    const Materials materials(scene, ray_caster);
    SceneSummary summary;
    std::map<std::uint32_t, MaterialSummary> by_material;
    EmittingObjects objects;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        MaterialSummary& of_material = by_material[patch.material];
        add_shape(scene, patch, summary);
        if (patch.other_side == none || patch.other_side > i) add_face(scene, materials, i, summary, of_material);
        if (!(channel_sum(materials.exitance(i)) > 0)) continue;
        add_emission(scene, materials, i, summary, of_material);
        objects[patch.material].insert(patch.object);
    }
    for (auto& [material, m] : by_material) {
        m.material = material;
        m.emitting_objects = objects[material].size();
        if (m.area > 0) m.reflectance /= m.area;
        summary.materials.push_back(m);
    }
    const Emission emission(scene);
    summary.luminaires.assign(scene.luminaires.size(), RgbD(0));
    for (std::size_t part = 0; part < emission.part_count(); ++part)
        summary.luminaires[emission.luminaire(part)] += emission.power(part);
    summary.emitted_power += emission.total_power();
    return summary;
}

}  // namespace interflect
