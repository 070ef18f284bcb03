#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <string>
#include <vector>

#include "interflect/colour.h"

namespace interflect {

/// Texture coordinates (u, v): (0, 0) is the lower left corner of the image, (1, 1) the upper right. The image repeats.
using V2f = Imath::V2f;

/// An image that multiplies a material's reflectance, exitance or transmittance.
struct Texture {
    std::string name;  ///< Source file.
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> texels;  ///< Linear Rec. 709, >= 0, row by row, row 0 at the top: [y * width + x].
};

/// Limits: texels of all textures of a scene, 12 bytes each; texels along the side of an image.
inline constexpr std::uint64_t most_texels = std::uint64_t{1} << 26;
inline constexpr std::uint32_t most_texels_of_side = 1u << 14;

/// Largest texture coordinate. Single precision resolves 1 / 2000 texel there.
inline constexpr float farthest_texture_coordinate = 4096;

/// Bilinear interpolation of the texture at (u, v), between texel centres.
Rgb texel_at(const Texture& texture, const V2f& coordinate);

/// Maximum of each channel: an upper bound of the interpolated texture.
Rgb largest_texel(const Texture& texture);

/// Fault of a texture (its size, a texel that is negative or not finite), in words without a subject; empty if valid.
std::string texture_fault(const Texture& texture);

/// Fault of texture coordinates, in the same form.
std::string texture_coordinate_fault(const V2f& coordinate);

}  // namespace interflect
