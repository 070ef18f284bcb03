#pragma once

#include "interflect/colour.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Light that reaches a point straight from a luminaire, if nothing is in its way.
struct Illumination {
    V3f towards{0, 0, 1};     ///< Unit direction to the luminaire.
    float distance = 0;       ///< To it [m]; infinite for directional light.
    Rgb irradiance{0, 0, 0};  ///< Of a surface that faces it [lm/m^2 or W/m^2]; 0 from a sky, which has no direction.
};
/// @param x  Relative to the scene's origin [m].
Illumination illumination(const Luminaire& luminaire, const V3f& x);

/// What is seen where nothing is in the way: the radiance of all skies [cd/m^2 or W/(m^2 sr)].
Rgb sky_radiance(const Scene& scene);

}  // namespace interflect::inline detail
