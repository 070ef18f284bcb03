#pragma once

#include <cstdint>
#include <vector>

#include "interflect/texture.h"

namespace interflect::inline detail {

/// Halves width and height of the largest textures, again and again, until all together have at most `most` texels.
/// Those of equal size stay of equal size; every texel becomes the mean of what it covers. @return  Whether any was.
bool reduce_textures(std::vector<Texture>& textures, std::uint64_t most = most_texels);

/// Of all textures.
std::uint64_t texel_count(const std::vector<Texture>& textures);

}  // namespace interflect::inline detail
