#pragma once

#include <vector>

#include "interflect/solver/error/error_weight.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Mean squared errors of the elements. The bias may be negative. With ErrorMeasure::pictures, elements below invisible
/// parents have 0.
struct ElementErrors {
    std::vector<float> noise, bias;
    std::vector<float> noise_of_patch;  // part of `noise`: variance of the mean of the element's patch
};
ElementErrors element_errors(const RunInputs& inputs, const LightState& light, ErrorMeasure measure);

/// Estimated errors relative to error_reference(); see IterationReport.
struct ErrorEstimate {
    double noise = 0, discretisation = 0;

    double total() const;
};

/// Returns infinite errors until two iterations have been compared, or if the relevant surfaces are dark.
ErrorEstimate estimate_error(const SolverState& state, ErrorMeasure measure);
inline ErrorEstimate estimate_error(const SolverState& state) {
    return estimate_error(state, default_measure(state.light));
}

}  // namespace interflect::detail
