#pragma once

#include "interflect/scene.h"

namespace interflect::detail {

// Generated images of 8-bit sRGB values, which PNG preserves.

Texture make_tiles();
/// Framed letter that indicates up and right.
Texture make_label();
Texture make_louvres();

std::uint32_t add_texture(Scene& scene, Texture texture);

/// Gives a quadrilateral its own vertices with texture coordinates, from the lowest edge upwards.
/// @param repeat  Side of the repeated image [m]; 0 covers the patch once.
void lay_image(Scene& scene, PatchIndex patch, float repeat = 0);

}  // namespace interflect::detail
