#pragma once

#include "interflect/geometry/patch_geometry.h"
#include "interflect/geometry/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Interpolated texture coordinates at a point of a patch. @param scene  With texture coordinates.
V2f texture_coordinate(const Scene& scene, const Patch& patch, Parameters p);

/// All coordinates of a new vertex at this point.
VertexCoordinates coordinates_at(const Scene& scene, const Patch& patch, Parameters p);

/// Reflectance, exitance [lm/m^2 or W/m^2] and transmittance at a point of a patch: the material's value times the
/// texel.
Rgb reflectance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb exitance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb transmittance_at(const Scene& scene, const Patch& patch, Parameters p);

}  // namespace interflect::detail
