#pragma once

#include <cstdint>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Computes the indirect importance bounce by bounce (Eq. 7, 8), with about `rays` rays. @throws Interrupted
void transport_importance(SolverState& state, std::int64_t rays);

}  // namespace interflect::detail
