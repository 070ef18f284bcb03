#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <string>
#include <vector>

#include "interflect/colour.h"

namespace interflect {

/// Texture coordinates (u, v): (0, 0) is the image's lower left corner, (1, 1) the upper right; it repeats beyond.
using V2f = Imath::V2f;

/// An image by which surfaces multiply their material's reflectance or exitance.
struct Texture {
    std::string name;  ///< The file it came from.
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> texels;  ///< Linear Rec. 709, >= 0, row by row, row 0 at the top: [y * width + x].
};

/// Texels of all textures of a scene: 12 bytes each. Largest side of an image.
inline constexpr std::uint64_t most_texels = std::uint64_t{1} << 26;
inline constexpr std::uint32_t most_texels_of_side = 1u << 14;

/// Farthest texture coordinate: single precision still tells a texel in two thousand apart there.
inline constexpr float farthest_texture_coordinate = 4096;

/// The texture at (u, v): linear between the centres of the four nearest texels.
Rgb texel_at(const Texture& texture, const V2f& coordinate);

/// The largest of each channel; what no point of the texture exceeds.
Rgb largest_texel(const Texture& texture);

/// What is wrong with a texture by itself (its size, a texel that is negative or not finite), in words without a
/// subject; empty where nothing is.
std::string texture_fault(const Texture& texture);

/// What is wrong with texture coordinates, likewise.
std::string texture_coordinate_fault(const V2f& coordinate);

}  // namespace interflect
