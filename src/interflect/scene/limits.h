#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::inline detail {

// What can be computed: geometry and light are in single precision, which ends at 3 * 10^38 and loses digits below
// 10^-38. Variances of what an element receives go with the square of its irradiance, and with the inverse square of
// its area. No real scene comes near.

/// Farthest coordinate of a face or a view, in the world and from the scene's origin [m]: there, double precision still
/// tells an eighth of a metre.
inline constexpr double farthest_coordinate = 1e15;

/// Widest face, the diagonal of its bounding box [m]: about the Earth.
inline constexpr double widest_face = 1e7;

/// Narrowest scene, the diagonal of its bounding box [m]: two wavelengths of light. Smallest face [m^2].
inline constexpr double narrowest_scene = 1e-6;
inline constexpr float smallest_face_area = 1e-18f;

/// Exitance of any channel [lm/m^2 or W/m^2]: the Sun has 6 * 10^9 lm/m^2. What is brightest in a scene must not be
/// weaker than `weakest_exitance`, but may be dark.
inline constexpr float weakest_exitance = 1e-9f, strongest_exitance = 1e10f;

/// Whether every coordinate of a point is finite and at most farthest_coordinate.
bool is_within_reach(const Imath::V3d& point);

/// Diagonal of the bounding box of all patches whose vertices exist [m]; 0 where there is none.
double scene_width(const Scene& scene);

// What is wrong with a part of a scene, in words without a subject ("is 2e9 m wide, ..."); empty where nothing is.

/// @param patch  Its vertices exist.
std::string patch_fault(const Scene& scene, const Patch& patch);
/// @param width  Diagonal of the bounding box of all faces [m], scene_width().
std::string scene_width_fault(double width);
std::string exitance_fault(const Rgb& exitance);
/// @param strongest  brightest_source(scene).
std::string brightness_fault(float strongest);

/// The largest texel of every texture. O(texels).
std::vector<Rgb> largest_texels(const Scene& scene);

/// A material's reflectance or exitance times the largest texel of its texture, if it has one.
/// @param texture  Index into Scene::textures, or none. @param largest  largest_texels().
inline Rgb textured(const Rgb& factor, std::uint32_t texture, const std::vector<Rgb>& largest) {
    return texture == none ? factor : factor * largest[texture];
}

/// The largest sum, over a textured surface, of the shares of light that a material reflects, mirrors and lets through.
/// Exact where the textures of its reflectance and transmittance have the same size; else an upper bound.
/// @param largest  largest_texels() of `textures`.
Rgb largest_sum(const Material& material, const std::vector<Texture>& textures, const std::vector<Rgb>& largest);

/// Largest channel of what materials, times their textures, and luminaires are rated by, each in its unit; 0 where none
/// emits. @param scene  Its materials' textures exist. O(texels).
float brightest_source(const Scene& scene);

}  // namespace interflect::inline detail
