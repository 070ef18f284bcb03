#pragma once

#include <ImathBox.h>

#include <optional>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/solution.h"

namespace interflect::command {

/// All surfaces of a material. Colours are luminances.
struct SurfaceFacts {
    std::string material;
    double area = 0;  ///< Area, of one side only for two-sided faces [m^2].
    double reflectance = 0, transmittance = 0, specular_reflectance = 0;
};

struct LightFacts {
    std::string name;       ///< Material, photometric file or kind of light.
    std::string kind;       ///< "surface", or kind_name().
    std::size_t count = 0;  ///< Luminaires, or emitting objects.
    bool far_away = false;  ///< Whether it is the sky or the sun, of which `flux` is the part towards the scene.
    double flux = 0;        ///< Total flux [lm].
    std::optional<double> luminance;  ///< [cd/m^2], if equal in all directions.
};

struct SceneFacts {
    Imath::Box3d bounds;                 ///< World coordinates [m].
    std::vector<SurfaceFacts> surfaces;  ///< Sorted by area.
    std::vector<LightFacts> lights;      ///< Sorted by flux.
    PowerBalance balance;
};

SceneFacts facts_of(const SolvedScene& solved, const RayCaster& ray_caster);

}  // namespace interflect::command
