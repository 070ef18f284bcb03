#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solution.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// Makes the oracle of the next step.
/// @param rays      Number of rays in the running mean after this step, > 0.
/// @param min_area  Minimum area of elements [m^2].
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// Returns the power to which epsilon is relative [lm or W]: visible area times mean irradiance of the pictures. If
/// this is 0 or there is no view, returns the emitted power.
double reference_power(const Solution& so_far);

/// Returns psi_max of Eq. 15 [1/m^2]: the area-weighted mean over visible patches.
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::detail
