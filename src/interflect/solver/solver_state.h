#pragma once

#include <ImathBox.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solve.h"
#include "interflect/solver/element_floor.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/neighbourhoods.h"
#include "interflect/solver/noise_model.h"
#include "interflect/solver/risk_check.h"
#include "interflect/solver/schedule.h"
#include "interflect/solver/state_archive.h"
#include "interflect/solver/stop_request.h"
#include "interflect/solver/transport.h"
#include "interflect/solver/view_importance.h"

namespace interflect::inline detail {

/// The state of a run: everything that one iteration hands to the next.
struct SolverState {
    /// @param scene, caster  Must outlive it.
    SolverState(const Scene& scene, const RayCaster& caster, const SolveOptions& o);
    SolverState(const SolverState&) = delete;

    const Scene& scene;
    const Scene* lit = &scene;  // the same, with sources as they are dimmed
    Materials materials;
    std::vector<Imath::Box3f> targets;  // for light from outside, for the present views
    Emission emission;                  // of the luminaires
    const RayCaster& ray_caster;
    const SourceGroups groups;
    Solution solution;
    const SolveOptions& options = solution.options;
    const std::shared_ptr<ElementForest> forest;
    ViewImportance view;
    ElementFloor floor;
    Neighbourhoods neighbourhoods;                // none without a view
    std::vector<PartImportance> part_importance;  // that the luminaires' rays have found for the present views
    SampleStreams streams;
    Arrivals arrivals;
    Schedule schedule;
    std::vector<float> history;  // of each element: rays that its mean stands for
    NoiseModel noise;
    RiskCheck risk_check;
    Quanta quanta;  // of the last iteration
    std::int64_t power_rays = 0, importance_rays = 0, escaped_rays = 0;
    std::int64_t rays_of_other_views = 0;  // averaged before the views were changed
    RgbD escaped_power{0, 0, 0};           // mean of the iterations, as irradiance is
    double escaped_power_rays = 0;         // that it stands for

    // Of the work that is under way:
    std::function<void(const IterationReport&)> on_report;
    StopRequest stop;  // by the caller; once there is a first estimate, by the limit of time too
    StopRequest::Clock::time_point start;
    StopRequest::Clock::time_point last_step =
        StopRequest::Clock::time_point::max();  // none begins later, but the first
    bool has_traced_step = false;
    double earlier_seconds = 0;  // that earlier work took

    /// @param step_seconds  In which steps may begin.
    void begin_work(const Monitor& monitor, double step_seconds);
    void end_work() { earlier_seconds = seconds(); }
    /// Of all work so far.
    double seconds() const {
        return earlier_seconds + std::chrono::duration<double>(StopRequest::Clock::now() - start).count();
    }
    bool may_begin_step() const { return !has_traced_step || StopRequest::Clock::now() < last_step; }

    /// @throws std::runtime_error where what is read does not fit together.
    void archive(StateArchive& archive);
};

/// The sources emit what those of another scene do, which must outlive the state: the same but for that.
void set_sources(SolverState& state, const Scene& lit);

/// Replaces the targets of light from outside, and forgets the importance of the luminaires' parts.
void set_targets(SolverState& state, std::vector<Imath::Box3f> targets);

/// Finds what the views of the options show; importance is not known then.
void look(SolverState& state);

/// Traces a step's rays; afterwards everything kept by element has grown with the forest. @throws Interrupted
Received run_step(SolverState& state, TransportStep step);

/// What each light group shoots of `irradiance`, and where `emits`, of its own; refers to them.
GroupRadiosity group_radiosity(const SolverState& state, const GroupLight& irradiance, bool emits = true);

/// All power that leaves surfaces and luminaires [lm or W].
RgbD radiated_power(const SolverState& state);

/// The smallest area that an element's parts may have, and the area that a pixel shows there: see ElementFloor [m^2].
float min_area(const SolverState& state, std::uint32_t element);
float pixel_area(const SolverState& state, std::uint32_t element);

/// Gives elements from `first` on, made since, what their parents have.
void grow_with_forest(SolverState& state, std::uint32_t first);

/// Adds camera rays in proportion to the rays that have been averaged: as the mesh gets finer, what a view shows of
/// each element must be known as well.
void refine_view_importance(SolverState& state);

/// Adds a report of where the run stands. @param escaped_power  Averaged as irradiance is.
void report(SolverState& state, int iteration, const RgbD& escaped_power);

}  // namespace interflect::inline detail
