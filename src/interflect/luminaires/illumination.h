#pragma once

#include "interflect/core.h"
#include "interflect/light_sources.h"

namespace interflect::detail {

/// Light of a luminaire at a point, without occlusion.
struct Illumination {
    V3f towards{0, 0, 1};     ///< Unit direction.
    float distance = 0;       ///< Length of the shadow ray [m]; infinite for directional light.
    Rgb irradiance{0, 0, 0};  ///< On a surface perpendicular to `towards` [lm/m^2 or W/m^2]; 0 for skies.
};
/// Samples a point of a disc or opening; the mean over u and v is the total.
/// @param x     Relative to the scene's origin [m].
/// @param u, v  In (0, 1).
Illumination illumination(const Luminaire& luminaire, const V3f& x, float u = 0.5f, float v = 0.5f);

}  // namespace interflect::detail
