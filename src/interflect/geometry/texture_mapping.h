#pragma once

#include <optional>

#include "interflect/geometry/patch_geometry.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Texture coordinates at a point of a patch: linear on a triangle, bilinear on a quadrilateral, between its vertices.
/// @param scene  Has texture coordinates.
V2f texture_coordinate(const Scene& scene, const Patch& patch, Parameters p);

/// The same; none where the scene has no texture coordinates.
inline std::optional<V2f> coordinate_at(const Scene& scene, const Patch& patch, Parameters p) {
    if (scene.texture_coordinates.empty()) return std::nullopt;
    return texture_coordinate(scene, patch, p);
}

/// Reflectance, exitance [lm/m^2 or W/m^2] and transmittance at a point of a patch: those of its material, times the
/// texels there.
Rgb reflectance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb exitance_at(const Scene& scene, const Patch& patch, Parameters p);
Rgb transmittance_at(const Scene& scene, const Patch& patch, Parameters p);

}  // namespace interflect::inline detail
