#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Also calls the monitor.
void append_report(SolverState& state, int iteration);

}  // namespace interflect::detail
