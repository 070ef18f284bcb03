#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Shrinks differences of siblings if enabled; computes errors and ray counts of elements.
void finish_solution(SolverState& state);

}  // namespace interflect::detail
