#pragma once

#include <cstdint>

#include "interflect/base/files/state_archive.h"
#include "interflect/solver/state/inputs.h"
#include "interflect/solver/state/light_state.h"
#include "interflect/solver/state/sampling_state.h"
#include "interflect/solver/state/schedule.h"
#include "interflect/solver/state/work.h"

namespace interflect::detail {

/// Numbers of rays since the run began.
struct RayTotals {
    Schedule schedule;
    std::int64_t power = 0, importance = 0, escaped = 0;
    std::int64_t of_other_views = 0;       // rays averaged before the views changed
    std::int64_t of_first_importance = 0;  // rays of transport_importance() for the current views
};

/// State of a run that persists between iterations.
struct SolverState {
    /// @param scene, caster  Must outlive this.
    SolverState(const Scene& scene, const RayCaster& caster, const SolveOptions& options);
    SolverState(const SolverState&) = delete;

    RunInputs inputs;
    LightState light;
    SamplingState sampling;
    RayTotals rays;
    Work work;

    /// @throws std::runtime_error if the data are inconsistent.
    void archive(StateArchive& archive);
};

/// Computes the view importance of every element. Resets the indirect importance.
void compute_view_importance(SolverState& state);

/// Traces more camera rays if their number is small, relative to the averaged rays.
void refine_view_importance(SolverState& state);

/// Initialises new elements (index >= first) from their parents.
void grow_with_forest(SolverState& state, std::uint32_t first);

}  // namespace interflect::detail
