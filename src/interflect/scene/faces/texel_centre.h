#pragma once

#include <cstddef>

#include "interflect/scene.h"

namespace interflect::detail {

/// @param i  Index into Texture::texels.
inline V2f texel_centre(const Texture& texture, std::size_t i) {
    const std::size_t column = i % texture.width, row = i / texture.width;
    return {(static_cast<float>(column) + 0.5f) / static_cast<float>(texture.width),
            1 - (static_cast<float>(row) + 0.5f) / static_cast<float>(texture.height)};
}

}  // namespace interflect::detail
