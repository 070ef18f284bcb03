#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interflect/solver/methods/particles/path_batch.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

/// Batches of paths. The length of the paths of a batch determines the number of paths of the next batch.
struct PathSeries {
    std::uint64_t key = 0;
    std::uint64_t batches = 0;
    std::int64_t pilot_rays = 0;
    double rays_per_path = 0;  ///< Mean in the last batch or the pilot; 0: unknown.
};

/// @throws std::runtime_error naming the archived array.
void require_valid(const PathSeries& series, const std::string& name);

struct BatchResult {
    /// Irradiance, or importance per area, of each element. Inner elements have the mean of their children.
    std::vector<Rgb> irradiance;
    std::vector<HitSum> hits;  ///< Hits of each leaf; empty unless WalkSource::starts_at_hits.
    RgbD escaped{0, 0, 0};
    std::int64_t rays = 0;
};

/// Traces one batch of about `rays` rays. @throws Interrupted; `series` may then have changed.
BatchResult walk(SolverState& state, const WalkSource& walk_source, std::int64_t rays, PathSeries& series);

/// Returns the emission of leaves and luminaires, with density 1.
WalkSource light_source(const RunInputs& inputs, const LightState& light);

}  // namespace interflect::detail
