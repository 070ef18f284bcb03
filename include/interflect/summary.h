/// @file
/// Extent of a scene; areas, reflectances and emitted power of its materials.
#pragma once

#include <ImathBox.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/core.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect {

/// All patches of a material.
struct MaterialSummary {
    std::uint32_t material = 0;        ///< Index into Scene::materials.
    double area = 0;                   ///< Area of its faces, one side of each [m^2].
    RgbD reflectance{0, 0, 0};         ///< Mean reflectance of these faces, with textures.
    std::size_t emitting_patches = 0;  ///< Number of patches that emit.
    std::size_t emitting_objects = 0;  ///< Objects that contain these patches.
    double emitting_area = 0;          ///< Area of these patches [m^2].
    RgbD power{0, 0, 0};               ///< Emitted power [lm or W].
};

/// Extent and emission of a scene.
struct SceneSummary {
    Imath::Box3d bounds;                     ///< World coordinates [m].
    std::size_t triangles = 0;               ///< Number of triangular patches; others are quadrilaterals.
    std::size_t two_sided = 0;               ///< Number of patches on two-sided faces.
    double area = 0;                         ///< Area of all faces, one side of each [m^2].
    RgbD emitted_power{0, 0, 0};             ///< Power emitted by surfaces, and by luminaires into the scene [lm or W].
    std::vector<MaterialSummary> materials;  ///< Used materials, by index.
    std::vector<RgbD> luminaires;            ///< Power of each luminaire; of skies and suns, into the scene [lm or W].
};

/// Summarises a scene. Parts of emitters that coincident faces cover do not emit. O(patches).
/// @throws InputError for a ray caster of another scene.
SceneSummary summarise(const Scene& scene, const RayCaster& ray_caster);

/// Emission that is lost because coincident faces cover the emitters.
struct CoveredEmission {
    std::int64_t wholly = 0, partly = 0;  ///< Number of emitting patches that are wholly and partly covered.
    RgbD power{0, 0, 0};                  ///< Lost power [lm or W].
};

/// @throws InputError for a ray caster of another scene.
CoveredEmission covered_emission(const Scene& scene, const RayCaster& ray_caster);

}  // namespace interflect
