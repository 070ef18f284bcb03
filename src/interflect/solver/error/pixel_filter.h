#pragma once

#include <array>
#include <cstdint>

#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/noise/risk_check.h"
#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

// These functions return the share of a variance on surfaces that remains in pictures, because pixels are means over
// their squares. The share is 1 for ErrorMeasure::surfaces.

float shown_of_patch(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, PatchIndex patch);
/// @param pixels  Number of pixels that the cluster covers.
float shown_of_cluster(double pixels);
float shown_of_siblings(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, ElementIndex first);
/// Returns the share for each level of possible descendants of a leaf. Assumes variation along one side, as at the edge
/// of a shadow.
std::array<float, finer_levels> shown_within(const RunInputs& inputs, const LightState& light, ErrorMeasure measure,
                                             ElementIndex leaf);

}  // namespace interflect::detail
