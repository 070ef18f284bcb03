#pragma once

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Splits leaves whose irradiance is expected to vary by more than the children's noise. Does not split leaves of
/// minimum size or negligible error (docs/method/method.md, A run).
void refine_by_variance(SolverState& state);

/// Marks the leaves whose reflected rays start at hit points (StartPoints). Returns an empty array if
/// refine_by_variance() does not make the mesh.
std::vector<std::uint8_t> leaves_reflecting_where_received(const SolverState& state);

}  // namespace interflect::detail
