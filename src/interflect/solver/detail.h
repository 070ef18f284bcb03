#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solver/solver_state.h"

namespace interflect::inline detail {

/// What four siblings tell of how irradiance varies over their parent, in luminance [(lm/m^2)^2 or (W/m^2)^2].
struct Detail {
    float spread = 0;  ///< Area-weighted mean square of their differences from the parent: signal and noise.
    float noise = 0;   ///< The expected part of it that is noise; infinite where nothing was measured yet.
    /// What is assumed of the signal where the siblings have met few of the rays that their parent has met; negative
    /// where it is known from them.
    float assumed = -1;

    bool is_young() const { return assumed >= 0; }
    /// Unbiased, and may be negative, where it is not assumed.
    float signal() const { return is_young() ? assumed : spread - noise; }
    /// The factor by which differences are reduced: Wiener's filter, with the signal taken from the siblings
    /// themselves. 1 where they differ by much more than their noise, 0 where by no more.
    float shrinkage() const;
    /// What is left of the mean square error of the siblings, beyond that of their parent, once their differences are
    /// reduced: unbiased (Stein 1981, for three dimensions: the four differences sum to zero).
    float risk() const;
};

/// The detail of the siblings `first` ... `first` + 3.
Detail detail_of(const SolverState& state, std::uint32_t first);

/// Enters an iteration of so many rays into the noise model. Call before it is merged with the mean.
void estimate_noise(SolverState& state, const FreshEstimate& fresh, std::int64_t rays);

/// Estimated errors of a solution, relative to the weighted mean of what counts: IterationReport says what that is.
struct SolutionError {
    double noise = 0, discretisation = 0;

    double total() const;
};

/// Domain of the error: the pictures of the views, or all surfaces.
enum class ErrorMeasure { pictures, surfaces };
/// Pictures where a run has views.
ErrorMeasure default_measure(const SolverState& state);

/// @return infinities where nothing is known yet, or nothing that counts is lit.
SolutionError solution_error(const SolverState& state, ErrorMeasure measure);
inline SolutionError solution_error(const SolverState& state) { return solution_error(state, default_measure(state)); }

/// Weight of the squared error of an element's irradiance (luminance), per area. Pictures: view importance times the
/// squared luminance of the reflectance; surfaces: 1.
double error_weight(const SolverState& state, ErrorMeasure measure, std::uint32_t element);

/// What errors are relative to: the weighted mean of the luminance of reflected light, or of irradiance.
double error_reference(const SolverState& state, ErrorMeasure measure);

/// Completes the solution: reduces the differences of siblings by their noise where that is asked for, and tells what
/// is known of each element beside its irradiance.
void finish_solution(SolverState& state);

}  // namespace interflect::inline detail
