#pragma once

#include <optional>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

/// Sampled point of an emitting patch, as seen from a point x.
struct PatchPoint {
    Parameters at;
    V3f direction;
    float distance2 = 0;  ///< [m^2]
    float density = 0;    ///< Density of the direction [1/sr].
};

/// Samples the emitting side of a patch: uniformly in the solid angle seen from x if the patch is near, else uniformly
/// in its area. Sampling by area fails near the patch, because the integrand 1 / distance^2 grows without bound.
/// @param u, v  In (0, 1).
/// @return      nullopt if x is behind the patch or the point coincides with x.
std::optional<PatchPoint> sample_patch(const PatchGeometry& patch, const V3f& x, float u, float v);

/// Returns the density of sample_patch() [1/sr] for a direction that meets the emitting side.
/// @param distance2  Squared distance of the point [m^2].
float patch_density(const PatchGeometry& patch, const V3f& x, const V3f& direction, float distance2);

}  // namespace interflect::detail
