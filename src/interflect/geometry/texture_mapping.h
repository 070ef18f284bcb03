#pragma once

#include "interflect/geometry/patch_geometry.h"
#include "interflect/geometry/vertex_coordinates.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Texture coordinates at a point of a patch: linear on a triangle, bilinear on a quadrilateral, between its vertices.
/// @param scene  Has texture coordinates.
V2f texture_coordinate(const Scene& scene, const Patch& patch, Parameters p);

/// The coordinates of a vertex there, interpolated likewise: those that the scene has.
VertexCoordinates coordinates_at(const Scene& scene, const Patch& patch, Parameters p);

/// Reflectance, exitance [lm/m^2 or W/m^2] and transmittance at a point of a patch: those of its material, times the
/// texels there.
Rgb reflectance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb exitance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb transmittance_at(const Scene& scene, const Patch& patch, Parameters p);

}  // namespace interflect::inline detail
