#pragma once

#include <cstddef>

#include "interflect/texture.h"

namespace interflect::inline detail {

/// Texture coordinates of the centre of a texel. @param i  Index into Texture::texels.
inline V2f texel_centre(const Texture& texture, std::size_t i) {
    const auto x = static_cast<float>(i % texture.width), y = static_cast<float>(i / texture.width);
    return {(x + 0.5f) / static_cast<float>(texture.width), 1 - (y + 0.5f) / static_cast<float>(texture.height)};
}

}  // namespace interflect::inline detail
