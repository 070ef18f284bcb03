#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solution.h"
#include "interflect/solver/deposit/oracle.h"

namespace interflect::detail {

/// Makes the oracle of Eq. 14 or 15. @param rays  Averaged rays after this step, > 0.
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// Returns the reference of the threshold [lm or W] (docs/method.md, One step of transport); all emitted power if it is
/// unknown or 0.
double reference_power(const Solution& so_far);

/// Returns psi_max of Eq. 15 [1/m^2]: area-weighted mean over visible patches.
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::detail
