#include "interflect/solver/methods/baselines/random_walk.h"

#include <algorithm>
#include <cmath>

#include "interflect/base/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/methods/baselines/path_batch.h"

namespace interflect::detail {

namespace {

/// Paths of the pilot; minimum rays of a batch per pilot path.
constexpr std::int64_t pilot_paths = 512, rays_per_pilot_path = 16;

struct BatchResult {
    std::vector<Rgb> irradiance;  ///< By patch; or importance per area.
    RgbD escaped{0, 0, 0};
    std::int64_t rays = 0;
};

BatchResult follow_paths(SolverState& state, const WalkSource& payload, std::int64_t paths, std::uint64_t key) {
    PathBatch batch(state, payload, paths, key);
    const PathSums& sums = batch.follow();
    state.escaped_rays += sums.escaped_rays;
    state.streams.used.resize(sums.started.size(), 0);
    BatchResult arrived;
    for (std::uint32_t i = 0; i < sums.received.size(); ++i) {
        arrived.irradiance.push_back(Rgb(sums.unit.to_colour(sums.received[i])) / state.forest->area(i));
        state.streams.used[i] += static_cast<std::uint64_t>(sums.started[i]);
    }
    arrived.escaped = sums.unit.to_colour(sums.escaped);
    arrived.rays = sums.rays;
    return arrived;
}

/// Assumes equal, independent contributions.
Estimate independent_contributions(const SolverState& state, const BatchResult& batch) {
    const double power = luminance(integral(*state.forest, batch.irradiance));
    Estimate estimate{.irradiance = batch.irradiance, .escaped_power = batch.escaped};
    for (std::uint32_t i = 0; i < batch.irradiance.size(); ++i)
        estimate.variance.push_back(static_cast<float>(luminance(batch.irradiance[i]) * power /
                                                       (static_cast<double>(batch.rays) * state.forest->area(i))));
    return estimate;
}

BatchResult walk(SolverState& state, const WalkSource& payload, std::int64_t rays, PathSeries& series) {
    if (series.pilot_rays == 0) {  // discarded: a batch must not choose its own size
        const std::int64_t paths = std::clamp<std::int64_t>(rays / rays_per_pilot_path, 1, pilot_paths);
        series.pilot_rays = follow_paths(state, payload, paths, sub_key(series.key, WalkPurpose::pilot)).rays;
        series.rays_per_path = static_cast<double>(series.pilot_rays) / static_cast<double>(paths);
    }
    const auto paths = std::llround(static_cast<double>(rays) / std::max(1.0, series.rays_per_path));
    const std::int64_t at_least_one = std::max<std::int64_t>(1, paths);
    BatchResult arrived =
        follow_paths(state, payload, at_least_one, sub_key(series.key, WalkPurpose::batch, series.batches));
    series.rays_per_path = static_cast<double>(arrived.rays) / static_cast<double>(at_least_one);
    if (series.batches++ == 0) arrived.rays += series.pilot_rays;
    return arrived;
}

/// Returns psi of Eq. 10, or of Eq. 9 on request.
std::vector<float> leading_importance(const Solution& so_far) {
    switch (importance_use(so_far)) {
        case ImportanceUse::off:
            return {};
        case ImportanceUse::direct:
            return so_far.view_importance;
        case ImportanceUse::full:
            break;
    }
    return so_far.options.experimental.total_importance ? total_importance(so_far) : so_far.indirect_importance;
}

/// Returns beta + (1 - beta) psi, psi relative to its mean over emitted power.
std::vector<float> particle_density(const Solution& so_far, const std::vector<Rgb>& emitted) {
    std::vector<float> density = leading_importance(so_far);
    double power = 0, important = 0;
    for (std::size_t i = 0; i < density.size(); ++i) {
        const auto w = static_cast<double>(channel_sum(emitted[i]));
        power += w;
        important += w * density[i];
    }
    if (!(important > 0)) return std::vector<float>(emitted.size(), 1.0f);
    const double beta = so_far.options.experimental.beta;
    for (float& d : density) d = static_cast<float>(beta + (1 - beta) * d * power / important);
    return density;
}

WalkSource light(const SolverState& state) {
    WalkSource payload;
    for (std::uint32_t i = 0; i < state.forest->patch_count(); ++i) {
        payload.emitted.push_back(state.materials.exitance(i) * state.forest->area(i));
        payload.reflectance.push_back(state.materials.reflectance(i));
    }
    payload.density = particle_density(state.solution, payload.emitted);
    for (std::size_t i = 0; i < state.emission.part_count(); ++i) {
        payload.emitted.emplace_back(state.emission.power(i));
        payload.density.push_back(1);  // the mean: importance is unknown
    }
    return payload;
}

WalkSource importance_from_cameras(const SolverState& state) {
    WalkSource payload;
    payload.is_grey = true;
    for (std::uint32_t i = 0; i < state.forest->patch_count(); ++i) {
        const float rho = state.materials.mean_reflectance(i);
        payload.emitted.emplace_back(rho * state.solution.view_importance[i] * state.forest->area(i));
        payload.reflectance.emplace_back(rho);
    }
    payload.density.assign(state.forest->patch_count(), 1.0f);
    return payload;
}

}  // namespace

RandomWalks::RandomWalks(const SolverState& state)
    : current_{{sub_key(state.options.seed, WalkPurpose::light)},
               {sub_key(state.options.seed, WalkPurpose::importance)}} {}

void RandomWalks::prepare(SolverState& state) {
    before_ = current_;
    current_.importance.batches = 0, current_.importance.pilot_rays = 0, current_.importance_history = 0;
    walk_importance(state, std::min(state.schedule.start_rays(), lacking_importance(state, state.options.limits.rays)));
    state.schedule.record_start(0, state.importance_rays);
}

std::int64_t RandomWalks::lacking_importance(const SolverState& state, std::int64_t planned) const {
    if (importance_use(state.solution) != ImportanceUse::full) return 0;
    const std::int64_t share = std::llround(state.options.experimental.alpha * static_cast<double>(planned));
    return std::max<std::int64_t>(0, share - current_.importance_history);
}

void RandomWalks::walk_importance(SolverState& state, std::int64_t rays) {
    if (rays <= 0) return;
    const BatchResult arrived = walk(state, importance_from_cameras(state), rays, current_.importance);
    state.importance_rays += arrived.rays;
    current_.importance_history += rays;
    const auto tau = static_cast<float>(static_cast<double>(rays) / static_cast<double>(current_.importance_history));
    std::vector<float>& psi = state.solution.indirect_importance;
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] += tau * (arrived.irradiance[i].x - psi[i]);
}

void RandomWalks::update_importance(SolverState& state, IterationPlan& plan) {
    before_ = current_;
    plan.importance_rays = std::min(plan.rays, lacking_importance(state, state.schedule.rays() + plan.rays));
    const std::int64_t rays_before = state.importance_rays;
    walk_importance(state, plan.importance_rays);
    plan.traced = state.importance_rays - rays_before;
}

Estimate RandomWalks::trace(SolverState& state, IterationPlan& plan) {
    Estimate estimate;
    if (plan.rays > plan.importance_rays) {
        const BatchResult batch = walk(state, light(state), plan.rays - plan.importance_rays, current_.light);
        state.power_rays += batch.rays;
        plan.traced += batch.rays;
        estimate = independent_contributions(state, batch);
    }
    if (plan.traced == 0) plan.traced = plan.rays;  // no visible surface reflects
    return estimate;
}

void RandomWalks::merge(SolverState& state, const Estimate& estimate, const IterationPlan& plan) {
    if (estimate.irradiance.empty()) return;
    const bool shows_error = plan.rays >= state.schedule.start_rays();  // a remainder is too small
    if (shows_error) estimate_noise(state, estimate, plan.rays);
    const double before = state.history[0], now = before + static_cast<double>(plan.rays);
    const double tau = plan.warms_up ? 1 : static_cast<double>(plan.rays) / now;  // Eq. 6
    for (std::uint32_t i = 0; i < state.forest->size(); ++i)
        state.solution.irradiance[i] +=
            static_cast<float>(tau) * (estimate.irradiance[i] - state.solution.irradiance[i]);
    state.escaped_power += tau * (estimate.escaped_power - state.escaped_power);
    std::fill(state.history.begin(), state.history.end(), plan.warms_up ? 0.0f : static_cast<float>(now));
}

void RandomWalks::change_views(SolverState& state) {
    IterationMethod::change_views(state);
    current_.importance_history = 0;
    current_.importance.pilot_rays = 0;
}

void RandomWalks::archive(StateArchive& archive) {
    archive("random_walk/light", current_.light);
    archive("random_walk/importance", current_.importance);
    archive("random_walk/importance_history", current_.importance_history);
}

std::unique_ptr<IterationMethod> make_random_walks(SolverState& state) { return std::make_unique<RandomWalks>(state); }

}  // namespace interflect::detail
