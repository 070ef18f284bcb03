#pragma once

#include <cstdint>

#include "interflect/solver/noise/noise_model.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Updates the noise model and the RiskCheck. Call before the estimate is merged.
void estimate_noise(SolverState& state, const Estimate& fresh, std::int64_t rays);

}  // namespace interflect::detail
