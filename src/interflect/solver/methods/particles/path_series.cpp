#include "interflect/solver/methods/particles/path_series.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/light/materials.h"

namespace interflect::detail {

namespace {

/// Maximum number of paths of the pilot batch, and minimum number of rays of a batch per pilot path.
constexpr std::int64_t pilot_paths = 512, rays_per_pilot_path = 16;

BatchResult follow_paths(SolverState& state, const WalkSource& walk_source, std::int64_t paths, std::uint64_t key) {
    PathBatch batch(state, walk_source, paths, key);
    PathSums sums = batch.follow();
    state.rays.escaped += sums.escaped_rays;
    state.sampling.streams.used.resize(sums.started.size());
    BatchResult arrived;
    for (ElementIndex i{0}; i < sums.received.size(); ++i) {
        arrived.irradiance.push_back(Rgb(sums.unit.to_colour(sums.received[i])) / state.light.forest->area(i));
        state.sampling.streams.used.add(i, static_cast<std::uint64_t>(sums.started[i]));
    }
    pull(*state.light.forest, arrived.irradiance);
    arrived.hits = std::move(sums.hits);
    arrived.escaped = sums.unit.to_colour(sums.escaped);
    arrived.rays = sums.rays;
    return arrived;
}

}  // namespace

void require_valid(const PathSeries& series, const std::string& name) {
    StateArchive::require_range(
        series.pilot_rays >= 0 && series.rays_per_path >= 0 && std::isfinite(series.rays_per_path), name);
}

BatchResult walk(SolverState& state, const WalkSource& walk_source, std::int64_t rays, PathSeries& series) {
    // The light of the pilot is discarded, because a batch must not choose its own size.
    if (series.pilot_rays == 0) {
        const std::int64_t paths = std::clamp<std::int64_t>(rays / rays_per_pilot_path, 1, pilot_paths);
        series.pilot_rays = follow_paths(state, walk_source, paths, sub_key(series.key, WalkPurpose::pilot)).rays;
        series.rays_per_path = static_cast<double>(series.pilot_rays) / static_cast<double>(paths);
    }
    const auto paths = std::llround(static_cast<double>(rays) / std::max(1.0, series.rays_per_path));
    const std::int64_t at_least_one = std::max<std::int64_t>(1, paths);
    BatchResult arrived =
        follow_paths(state, walk_source, at_least_one, sub_key(series.key, WalkPurpose::batch, series.batches));
    series.rays_per_path = static_cast<double>(arrived.rays) / static_cast<double>(at_least_one);
    if (series.batches++ == 0) arrived.rays += series.pilot_rays;
    return arrived;
}

WalkSource light_source(const RunInputs& inputs, const LightState& light) {
    const ElementForest& forest = *light.forest;
    WalkSource walk_source;
    for (ElementIndex e{0}; e < forest.size(); ++e) {
        const MeanSurface surface = inputs.materials.surface(forest.patch(e), e);
        walk_source.emitted.push_back(forest.is_leaf(e) ? surface.exitance * forest.area(e) : Rgb(0));
        walk_source.reflectance.push_back(surface.reflectance);
    }
    for (std::size_t i = 0; i < inputs.emission.part_count(); ++i)
        walk_source.emitted.emplace_back(inputs.emission.power(i));
    walk_source.density.assign(walk_source.emitted.size(), 1.0f);
    return walk_source;
}

}  // namespace interflect::detail
