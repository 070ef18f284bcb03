#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Appends the report of an iteration to the solution, and passes it to the monitor.
void append_report(SolverState& state, int iteration);

}  // namespace interflect::detail
