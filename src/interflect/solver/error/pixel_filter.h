#pragma once

#include <array>
#include <cstdint>

#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/noise/risk_check.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

// Pixels are means over their squares, so pictures show only a share of the variation among small elements. The share
// is 1 for ErrorMeasure::surfaces.

/// For independent patches.
float shown_of_patch(const SolverState& state, ErrorMeasure measure, std::uint32_t patch);
/// For siblings `first` ... `first` + 3.
float shown_of_siblings(const SolverState& state, ErrorMeasure measure, std::uint32_t first);
/// For the descendants of a leaf, by level. Gradients and shadow edges vary along one side and continue in the
/// neighbours along the other. Sub-pixel elements are not aligned with pixels, so a small share remains.
std::array<float, finer_levels> shown_within(const SolverState& state, ErrorMeasure measure, std::uint32_t leaf);

}  // namespace interflect::detail
