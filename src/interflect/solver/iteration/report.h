#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Appends the state after an iteration to the history of the run, and calls the monitor.
void report(SolverState& state, int iteration);

}  // namespace interflect::detail
