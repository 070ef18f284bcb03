#pragma once

#include <cstdint>

#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Domain of the error: pictures of the views, or all surfaces.
enum class ErrorMeasure { pictures, surfaces };
/// Returns pictures if a view shows a surface.
ErrorMeasure default_measure(const LightState& light);

/// Weight per area. Pictures: view importance times squared luminance of rho. Surfaces: 1.
double error_weight(const RunInputs& inputs, const LightState& light, ErrorMeasure measure, ElementIndex element);

/// Weighted mean luminance: reflected light (pictures) or irradiance (surfaces).
double error_reference(const RunInputs& inputs, const LightState& light, ErrorMeasure measure);

}  // namespace interflect::detail
