#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/solver/light/group_light.h"

namespace interflect::detail {

/// Light that an iteration has estimated.
struct Estimate {
    std::vector<Rgb> irradiance = {};  ///< Irradiance H of each element [lm/m^2 or W/m^2].
    std::vector<float> variance = {};  ///< Variance of the luminance of `irradiance`, for independent rays.
    /// Variance of light from rays that the running mean shares, in addition to `variance`; empty: 0.
    std::vector<float> shared_variance = {};
    GroupLight groups = {};              ///< `irradiance` of each light group.
    GroupLight direct = {};              ///< Direct light, as Solution::direct; empty if unknown.
    std::vector<float> importance = {};  ///< Empty if the rays carried no importance.
    RgbD escaped_power{0, 0, 0};
    double shot_power = 0;  ///< Sum of the channels.
};

}  // namespace interflect::detail
