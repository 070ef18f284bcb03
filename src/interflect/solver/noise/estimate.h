#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/solver/light/group_light.h"

namespace interflect::detail {

struct Estimate {
    std::vector<Rgb> irradiance = {};  ///< H by element [lm/m^2 or W/m^2].
    std::vector<float> variance = {};  ///< Variance of its luminance, for independent rays.
    /// Variance of light by rays that the running mean has, too, in addition to `variance`; empty: 0.
    std::vector<float> shared_variance = {};
    GroupLight groups = {};              ///< `irradiance` by light group.
    GroupLight direct = {};              ///< As Solution::direct; empty if not known.
    std::vector<float> importance = {};  ///< Empty if not carried.
    RgbD escaped_power{0, 0, 0};
    double shot_power = 0;  ///< Sum of the channels.
};

}  // namespace interflect::detail
