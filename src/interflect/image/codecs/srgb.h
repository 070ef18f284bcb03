#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace interflect::detail {

/// Transfer function of sRGB (IEC 61966-2-1) for values in [0, 1].
inline float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

inline float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Clamps to [0, 1]. The value must not be NaN.
inline std::uint8_t srgb_byte(float linear) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb_encode(std::clamp(linear, 0.0f, 1.0f))));
}

}  // namespace interflect::detail
