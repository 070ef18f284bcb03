#pragma once

#include "interflect/solver/deposit/transport_step.h"
#include "interflect/solver/state/solver_state.h"
#include "interflect/solver/transport/received.h"

namespace interflect::detail {

/// Traces a step and grows all element data with the forest. @throws Interrupted
Received run_step(SolverState& state, TransportStep step);

}  // namespace interflect::detail
