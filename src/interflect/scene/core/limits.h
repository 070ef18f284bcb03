#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::detail {

// Limits for single precision: variances scale with the square of irradiance and the inverse square of element area.

/// Maximum diagonal of a face's bounding box [m]: about the diameter of the Earth.
inline constexpr double widest_face = 1e7;

/// Minimum diagonal of the scene's bounding box [m], two wavelengths of light; minimum area of a face [m^2].
inline constexpr double narrowest_scene = 1e-6;
inline constexpr float smallest_face_area = 1e-18f;

/// Range of the exitance of the brightest source [lm/m^2 or W/m^2]; the Sun has 6 * 10^9 lm/m^2. Dark scenes are valid.
inline constexpr float weakest_exitance = 1e-9f, strongest_exitance = 1e10f;

/// Returns the diagonal of all patches' bounding box [m]; 0 without patches. Ignores invalid vertices.
double scene_width(const Scene& scene);

// Functions *_fault() return a predicate ("is 2e9 m wide, ..."); empty if valid.

/// @param patch  With valid vertices.
std::string patch_fault(const Scene& scene, const Patch& patch);
std::string scene_width_fault(double width);
std::string exitance_fault(const Rgb& exitance);
/// @param strongest  brightest_source(scene).
std::string brightness_fault(float strongest);

std::vector<Rgb> largest_texels(const Scene& scene);

/// Returns the maximum of `factor` times its texture. @param largest  Result of largest_texels().
inline Rgb textured(const Rgb& factor, std::uint32_t texture, const std::vector<Rgb>& largest) {
    return texture == none ? factor : factor * largest[texture];
}

/// Returns the maximum of reflectance + specular reflectance + transmittance; an upper bound if textures differ in
/// size.
Rgb largest_sum(const Material& material, const std::vector<Texture>& textures, const std::vector<Rgb>& largest);

/// Returns the largest channel of textured exitances and luminaire ratings; 0 without sources. Requires valid texture
/// indices.
float brightest_source(const Scene& scene);

}  // namespace interflect::detail
