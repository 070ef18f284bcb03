#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Completes the solution: shrinks differences of siblings if enabled, and computes errors and ray counts of elements.
void finish_solution(SolverState& state);

}  // namespace interflect::detail
