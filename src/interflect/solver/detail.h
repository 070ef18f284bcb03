#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Variation of irradiance among four siblings, in squared luminance [(lm/m^2)^2 or (W/m^2)^2].
struct Detail {
    float spread = 0;  ///< Area-weighted mean square difference from the parent: signal plus noise.
    float noise = 0;   ///< Expected noise in `spread`; infinite if unknown.
    /// Assumed signal of under-sampled siblings; negative for all others.
    float assumed = -1;

    bool is_young() const { return assumed >= 0; }
    /// Unbiased and possibly negative, unless assumed.
    float signal() const { return is_young() ? assumed : spread - noise; }
    /// Wiener filter with the siblings' own signal: near 1 if it far exceeds the noise, 0 if differences are noise.
    float shrinkage() const;
    /// Mean square error after shrinkage, in addition to the parent's. Unbiased (Stein 1981, in three dimensions
    /// because the four differences sum to zero).
    float risk() const;
};

/// Returns the detail of the siblings `first` ... `first` + 3.
Detail detail_of(const SolverState& state, std::uint32_t first);

/// Updates the noise model with an iteration that has not been merged yet.
void estimate_noise(SolverState& state, const FreshEstimate& fresh, std::int64_t rays);

/// Estimated errors, relative to error_reference(); see IterationReport.
struct SolutionError {
    double noise = 0, discretisation = 0;

    double total() const;
};

/// Domain of the error: the pictures of the views, or all surfaces.
enum class ErrorMeasure { pictures, surfaces };
/// Returns pictures if a view shows a surface, else surfaces.
ErrorMeasure default_measure(const SolverState& state);

/// @return Infinite until two iterations have been compared, or if nothing relevant is lit.
SolutionError solution_error(const SolverState& state, ErrorMeasure measure);
inline SolutionError solution_error(const SolverState& state) { return solution_error(state, default_measure(state)); }

/// Weight of the squared error of an element's luminance, per area. Pictures: view importance times squared luminance
/// of the reflectance. Surfaces: 1.
double error_weight(const SolverState& state, ErrorMeasure measure, std::uint32_t element);

/// Weighted mean luminance of reflected light (pictures) or irradiance (surfaces).
double error_reference(const SolverState& state, ErrorMeasure measure);

/// Completes the solution: shrinks differences of siblings if enabled, and computes errors and ray counts of elements.
void finish_solution(SolverState& state);

}  // namespace interflect::inline detail
