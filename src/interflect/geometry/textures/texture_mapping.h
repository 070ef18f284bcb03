#pragma once

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/polygons/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Interpolates the scene's texture coordinates, which must exist.
V2f texture_coordinate(const Scene& scene, const Patch& patch, Parameters p);

VertexCoordinates coordinates_at(const Scene& scene, const Patch& patch, Parameters p);

/// These return the material's value times the texel. Exitances are in lm/m^2 or W/m^2.
Rgb reflectance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb exitance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb transmittance_at(const Scene& scene, const Patch& patch, Parameters p);

}  // namespace interflect::detail
