#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solution.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// Makes the oracle of the method (Eq. 14 or 15), relative to the references below.
/// @param rays  Number of rays averaged after this step, > 0. The threshold falls as it grows.
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// Returns the reference of the oracle's threshold [lm or W]: the power that visible patches receive at the mean
/// irradiance of the picture. It is independent of lamps in the picture, light elsewhere, tessellation and unit of
/// length. Without a view, or while the visible patches are dark: all emitted power.
double reference_power(const Solution& so_far);

/// Returns psi_max of Eq. 15 [1/m^2]: the area-weighted mean over the visible patches.
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::detail
