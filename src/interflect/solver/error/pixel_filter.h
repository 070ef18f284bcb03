#pragma once

#include <array>
#include <cstdint>

#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/noise/risk_check.h"
#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

// Shares of variance that pictures show: pixels are means over their squares. 1 for ErrorMeasure::surfaces.

float shown_of_patch(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, PatchIndex patch);
/// Of a cluster that covers `pixels` of the pictures.
float shown_of_cluster(double pixels);
float shown_of_siblings(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, ElementIndex first);
/// Returns the share for descendants of a leaf, by level. Assumes variation along one side, as at shadow edges.
std::array<float, finer_levels> shown_within(const RunInputs& inputs, const LightState& light, ErrorMeasure measure,
                                             ElementIndex leaf);

}  // namespace interflect::detail
