#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Splits leaves whose irradiance should vary by more than the children's noise, except for negligible errors or
/// minimum size (docs/method/method.md, A run).
void refine_by_variance(SolverState& state);

/// Marks leaves that reflect where they receive (StartPoints), if refine_by_variance() makes the mesh.
std::vector<std::uint8_t> leaves_reflecting_where_received(const SolverState& state);

}  // namespace interflect::detail
