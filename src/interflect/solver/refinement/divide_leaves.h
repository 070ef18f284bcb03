#pragma once

#include <cstdint>
#include <vector>

#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Subdivides the marked leaves, in order, up to RefinementOptions::max_elements. Children inherit their parent's mean
/// with a history of 0, because their differences are unknown.
/// @param splits  One value per element; nonzero for leaves to divide.
void divide_leaves(SolverState& state, const std::vector<std::uint8_t>& splits);

}  // namespace interflect::detail
