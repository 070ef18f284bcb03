#pragma once

#include <ImathColor.h>
#include <ImathVec.h>

#include <algorithm>
#include <cmath>

namespace interflect {

/// Linear Rec. 709 colour, or any quantity per channel in the unit of that quantity.
using Rgb = Imath::Color3f;
/// Double precision, for sums over many patches.
using RgbD = Imath::Color3<double>;
using V3f = Imath::V3f;

/// Rec. 709 luminance. Photometric quantities keep their unit: luminance({1, 1, 1}) == 1.
template <class T>
constexpr T luminance(const Imath::Color3<T>& c) {
    return T(0.2126) * c.x + T(0.7152) * c.y + T(0.0722) * c.z;
}

/// Sum of the channels, used for sampling probabilities so that every channel is sampled.
template <class T>
constexpr T channel_sum(const Imath::Color3<T>& c) {
    return c.x + c.y + c.z;
}

template <class T>
constexpr T largest_channel(const Imath::Color3<T>& c) {
    return std::max({c.x, c.y, c.z});
}

template <class T>
bool is_finite(const Imath::Vec3<T>& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

}  // namespace interflect
