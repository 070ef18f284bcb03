#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Appends an IterationReport and calls the monitor.
void report(SolverState& state, int iteration);

}  // namespace interflect::detail
