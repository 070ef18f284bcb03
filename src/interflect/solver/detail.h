#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// Variation of irradiance among four siblings, in luminance [(lm/m^2)^2 or (W/m^2)^2].
struct Detail {
    float spread = 0;  ///< Area-weighted mean square of their differences from the parent: signal plus noise.
    float noise = 0;   ///< Expected noise in `spread`; infinite before the first measurement.
    /// Assumed signal of under-sampled siblings; negative if the siblings themselves determine the signal.
    float assumed = -1;

    bool is_young() const { return assumed >= 0; }
    /// Unbiased and possibly negative, unless it is assumed.
    float signal() const { return is_young() ? assumed : spread - noise; }
    /// Factor for the differences: a Wiener filter with the signal estimated from the siblings themselves. Near 1 if
    /// they differ by much more than their noise, 0 if by no more than it.
    float shrinkage() const;
    /// Mean square error of the siblings after shrinkage, in addition to their parent's. Unbiased (Stein 1981, in three
    /// dimensions because the four differences sum to zero).
    float risk() const;
};

/// Returns the detail of the siblings `first` ... `first` + 3.
Detail detail_of(const SolverState& state, std::uint32_t first);

/// Updates the noise model with an iteration of `rays` rays. Call before the iteration is merged with the mean.
void estimate_noise(SolverState& state, const FreshEstimate& fresh, std::int64_t rays);

/// Estimated errors relative to error_reference(); see IterationReport.
struct SolutionError {
    double noise = 0, discretisation = 0;

    double total() const;
};

/// Domain of the error: the pictures of the views, or all surfaces.
enum class ErrorMeasure { pictures, surfaces };
/// Pictures if a view shows a surface, else surfaces.
ErrorMeasure default_measure(const SolverState& state);

/// @return Infinite until two iterations have been compared, or if nothing relevant is lit.
SolutionError solution_error(const SolverState& state, ErrorMeasure measure);
inline SolutionError solution_error(const SolverState& state) { return solution_error(state, default_measure(state)); }

/// Weight of the squared error of an element's irradiance (luminance), per area. Pictures: view importance times the
/// squared luminance of the reflectance; surfaces: 1.
double error_weight(const SolverState& state, ErrorMeasure measure, std::uint32_t element);

/// Reference of relative errors: the weighted mean luminance of reflected light (pictures) or of irradiance (surfaces).
double error_reference(const SolverState& state, ErrorMeasure measure);

/// Completes the solution: shrinks the differences of siblings if enabled, and computes the errors and ray counts of
/// the elements.
void finish_solution(SolverState& state);

}  // namespace interflect::inline detail
