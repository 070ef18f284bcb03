#pragma once

#include <ImathBox.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/base/sums/common_stop.h"
#include "interflect/base/sums/rank_sums.h"
#include "interflect/base/threads/stop_request.h"
#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solution.h"
#include "interflect/solver/clusters/patch_clusters.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/importance/neighbourhoods.h"
#include "interflect/solver/importance/view_importance.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/noise/noise_model.h"
#include "interflect/solver/noise/risk_check.h"
#include "interflect/solver/sampling/payload.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/state/element_floor.h"
#include "interflect/solver/state/schedule.h"

namespace interflect::detail {

/// 20 halvings in each chain reach from 10 km to 1 cm.
inline constexpr int max_chains = 4, max_targets = 80;

/// Persists between iterations.
struct SolverState {
    /// @param scene, caster  Must outlive this.
    SolverState(const Scene& scene, const RayCaster& caster, const SolveOptions& o);
    SolverState(const SolverState&) = delete;

    const Scene& scene;
    const Scene* lit = &scene;  // with dimmed sources
    Materials materials;
    std::vector<Imath::Box3f> targets;  // of outdoor light, for the current views
    Emission emission;
    const RayCaster& ray_caster;
    const SourceGroups groups;
    Solution solution;
    const SolveOptions& options = solution.options;
    const std::shared_ptr<ElementForest> forest;
    ViewImportance view;
    ElementFloor floor;
    std::vector<PatchClusters> clusters;          // empty if differences between patches are not shrunk
    Neighbourhoods neighbourhoods;                // empty without a view
    std::vector<PartImportance> part_importance;  // for the current views
    SampleStreams streams;
    ContributionSums contributions;
    Schedule schedule;
    std::vector<float> history;  // rays averaged into each element's mean
    NoiseModel noise;
    RiskCheck risk_check;
    PayloadHistogram payloads;  // of the last iteration
    std::int64_t power_rays = 0, importance_rays = 0, escaped_rays = 0;
    std::int64_t rays_of_other_views = 0;       // averaged before the views changed
    std::int64_t rays_of_first_importance = 0;  // of transport_importance() for these views
    RgbD escaped_power{0, 0, 0};                // mean, averaged like irradiance
    double escaped_power_rays = 0;              // rays in this mean
    double discarded_hits = 0;                  // see IterationReport

    // The work in progress, which alone may be shared with other ranks:
    Monitor monitor;
    CommonStop stop;  // after a first estimate, also by the time limit
    StopRequest::Clock::time_point start_of_this_call;
    double earlier_seconds = 0;
    Ranks::Traffic reported_traffic;

    void begin_work(const Monitor& m);
    void end_work();
    /// Time on the clock of rank 0 [s].
    double seconds_of_this_call() const {
        const std::chrono::duration<double> passed = StopRequest::Clock::now() - start_of_this_call;
        return of_first_rank(monitor.ranks, passed.count());
    }
    /// Includes earlier calls [s].
    double seconds() const { return earlier_seconds + seconds_of_this_call(); }

    /// @throws std::runtime_error if the data are inconsistent.
    void archive(StateArchive& archive);
};

/// `lit` must outlive the state.
void set_sources(SolverState& state, const Scene& lit);

/// Also resets the importance of luminaire parts.
void set_targets(SolverState& state, std::vector<Imath::Box3f> targets);

/// Resets the indirect importance.
void compute_view_importance(SolverState& state);

/// Refers to its arguments.
GroupRadiosity group_radiosity(const SolverState& state, const GroupLight& irradiance, bool emits = true);

/// Returns the power of surfaces and luminaires [lm or W].
RgbD radiated_power(const SolverState& state);

bool refines_by_variance(const SolveOptions& options);

/// Evaluates ElementFloor [m^2].
float min_area(const SolverState& state, std::uint32_t element);
float pixel_area(const SolverState& state, std::uint32_t element);

/// Initialises new elements (index >= first) from their parents.
void grow_with_forest(SolverState& state, std::uint32_t first);

/// In proportion to the averaged rays.
void refine_view_importance(SolverState& state);

}  // namespace interflect::detail
