#pragma once

#include <ImathBox.h>

#include <optional>
#include <string>
#include <vector>

#include "interflect/power_balance.h"
#include "interflect/ray_caster.h"
#include "interflect/solution_file.h"

namespace interflect::command {

/// All surfaces of a material. Photometric: of colours the luminance.
struct SurfaceFacts {
    std::string material;
    double area = 0;  ///< Of the fronts of two-sided faces [m^2].
    double reflectance = 0, transmittance = 0, specular_reflectance = 0;
};

/// Light sources of one kind.
struct LightFacts {
    std::string name;                 ///< Of the material, the photometric file or the light.
    std::string kind;                 ///< "surface", or kind_name().
    std::size_t count = 0;            ///< Luminaires; of surfaces the objects that emit.
    bool far_away = false;            ///< A sky or sun, whose flux is what comes towards the scene.
    double flux = 0;                  ///< Of all [lm].
    std::optional<double> luminance;  ///< [cd/m^2], where it is the same in all directions.
};

/// What there is to tell of a scene before any light is measured.
struct SceneFacts {
    Imath::Box3d bounds;                 ///< In the world [m].
    std::vector<SurfaceFacts> surfaces;  ///< By area.
    std::vector<LightFacts> lights;      ///< By flux.
    PowerBalance balance;
};

SceneFacts facts_of(const SolvedScene& solved, const RayCaster& ray_caster);

}  // namespace interflect::command
