#pragma once

#include <cstdint>
#include <vector>

#include "interflect/texture.h"

namespace interflect::inline detail {

/// Repeatedly halves the largest textures until all have at most `most` texels in total. Textures of equal size stay
/// equal; each texel becomes the mean of its area. @return  Whether it reduced any.
bool reduce_textures(std::vector<Texture>& textures, std::uint64_t most = most_texels);

/// Returns the total for all textures.
std::uint64_t texel_count(const std::vector<Texture>& textures);

}  // namespace interflect::inline detail
