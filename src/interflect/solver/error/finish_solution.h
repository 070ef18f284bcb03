#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Shrinks the differences of siblings, if this is enabled. Computes the errors and ray counts of the elements.
void finish_solution(SolverState& state);

}  // namespace interflect::detail
