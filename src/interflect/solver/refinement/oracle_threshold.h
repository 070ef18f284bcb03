#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solution.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// @param rays      In the running mean after this step, > 0.
/// @param min_area  Of elements [m^2].
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// Returns the power that epsilon is relative to [lm or W]: visible area times mean irradiance of the picture; if 0 or
/// without a view, all emitted power.
double reference_power(const Solution& so_far);

/// Returns psi_max of Eq. 15 [1/m^2]: the area-weighted mean over visible patches.
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::detail
