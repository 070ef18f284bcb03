#pragma once

#include "interflect/core.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Unoccluded light of a luminaire at a point.
struct Illumination {
    V3f towards{0, 0, 1};     ///< Unit direction to the luminaire.
    float distance = 0;       ///< Length of a shadow ray to it [m]; infinite for directional light.
    Rgb irradiance{0, 0, 0};  ///< On a surface that faces it [lm/m^2 or W/m^2]; 0 for skies, see Skies.
};
/// Samples one point of a disc or of a measured light's opening; the mean over u and v is the light of the whole.
/// @param x     Relative to the scene's origin [m].
/// @param u, v  Uniform in (0, 1); choose the point of an opening or disc.
Illumination illumination(const Luminaire& luminaire, const V3f& x, float u = 0.5f, float v = 0.5f);

}  // namespace interflect::detail
