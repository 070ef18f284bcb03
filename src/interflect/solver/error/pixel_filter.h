#pragma once

#include <array>
#include <cstdint>

#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/noise/risk_check.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

// Pixels are means over their squares, so pictures show only a share of the variation among small elements. Surfaces
// show all of it: the results are 1 for ErrorMeasure::surfaces.

/// Returns the share of the variance of independent patches.
float shown_of_patch(const SolverState& state, ErrorMeasure measure, std::uint32_t patch);
/// Returns the share of the variation among the siblings `first` ... `first` + 3.
float shown_of_siblings(const SolverState& state, ErrorMeasure measure, std::uint32_t first);
/// Returns the share of the variation among the descendants of a leaf that pictures show, by level. Gradients and edges
/// of shadows vary along one side only, and continue in the neighbours along the other. The share is small for elements
/// smaller than a pixel, but not 0, because elements are not aligned with pixels.
std::array<float, finer_levels> shown_within(const SolverState& state, ErrorMeasure measure, std::uint32_t leaf);

}  // namespace interflect::detail
