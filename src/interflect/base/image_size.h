#pragma once

#include <cstdint>

namespace interflect {

/// Larger images are neither rendered nor read, whatever a file claims.
inline constexpr std::int64_t most_image_pixels = std::int64_t{1} << 28;

}  // namespace interflect
