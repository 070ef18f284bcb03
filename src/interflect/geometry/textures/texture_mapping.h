#pragma once

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/polygons/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Requires texture coordinates.
V2f texture_coordinate(const Scene& scene, const Patch& patch, Parameters p);

VertexCoordinates coordinates_at(const Scene& scene, const Patch& patch, Parameters p);

/// Material's value times the texel; exitance in [lm/m^2 or W/m^2].
Rgb reflectance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb exitance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb transmittance_at(const Scene& scene, const Patch& patch, Parameters p);

}  // namespace interflect::detail
