#pragma once

#include "interflect/colour.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Light that reaches a point straight from a luminaire, if nothing is in its way.
struct Illumination {
    V3f towards{0, 0, 1};     ///< Unit direction to the luminaire.
    float distance = 0;       ///< Within which nothing may be in the way [m]; infinite for directional light.
    Rgb irradiance{0, 0, 0};  ///< Of a surface that faces it [lm/m^2 or W/m^2]; 0 from skies, which are in Skies.
};
/// Of measured light with an opening, and of a disc: from one point of that, so that the mean over u and v is what all
/// of it causes.
/// @param x     Relative to the scene's origin [m].
/// @param u, v  Uniform in (0, 1); they choose the point of an opening or disc.
Illumination illumination(const Luminaire& luminaire, const V3f& x, float u = 0.5f, float v = 0.5f);

}  // namespace interflect::inline detail
