#pragma once

#include <cstdint>

#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Domain over which errors are averaged: pictures of the views, or all surfaces.
enum class ErrorMeasure { pictures, surfaces };
/// Returns `pictures` if a view shows a surface, else `surfaces`.
ErrorMeasure default_measure(const LightState& light);

/// Returns the weight of squared errors per area: for pictures, view importance times the squared luminance of rho; for
/// surfaces, 1.
double error_weight(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, ElementIndex element);

/// Returns the mean luminance to which errors are relative: of the reflected light in pictures, or of the irradiance of
/// surfaces.
double error_reference(const RunInputs& inputs, const LightState& light, ErrorMeasure measure);

}  // namespace interflect::detail
