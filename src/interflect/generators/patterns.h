#pragma once

#include "interflect/scene.h"

namespace interflect::inline detail {

// Images for made scenes, of 8 bit sRGB values, so that a .png keeps them as they are.

/// Two by two tiles of two tones, between joints.
Texture make_tiles();
/// A printed box: a letter that shows which way is up and right, in a frame.
Texture make_label();
/// A luminaire behind louvres: six by six bright cells, brighter in their middles.
Texture make_louvres();

/// Adds a texture. @return its index.
std::uint32_t add_texture(Scene& scene, Texture texture);

/// Gives a quadrilateral vertices of its own, whose texture coordinates lay an image on it once, or, with a `repeat`
/// [m] above 0, in squares of that side. The image's bottom is at the lowest edge.
void lay_image(Scene& scene, std::uint32_t patch, float repeat = 0);

}  // namespace interflect::inline detail
