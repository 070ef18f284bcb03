#pragma once

#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Halves the largest textures, by means over areas, until they have at most `most` texels in total. Textures of equal
/// size keep equal sizes. Returns whether a texture was reduced.
bool reduce_textures(std::vector<Texture>& textures, std::uint64_t most = max_texels);

std::uint64_t texel_count(const std::vector<Texture>& textures);

}  // namespace interflect::detail
