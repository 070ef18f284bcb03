#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

// Generated images of 8-bit sRGB values, which a .png preserves.

/// Two by two tiles of two tones, with joints.
Texture make_tiles();
/// A box label: a framed letter that shows which way is up and right.
Texture make_label();
/// A luminaire behind louvres: six by six bright cells, brightest at their centres.
Texture make_louvres();

/// Adds a texture and returns its index.
std::uint32_t add_texture(Scene& scene, Texture texture);

/// Gives a quadrilateral its own vertices with texture coordinates. The image covers it once, or in squares of side
/// `repeat` [m] if that is above 0. Its bottom is at the lowest edge.
void lay_image(Scene& scene, std::uint32_t patch, float repeat = 0);

}  // namespace interflect::detail
