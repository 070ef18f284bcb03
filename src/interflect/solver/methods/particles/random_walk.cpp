#include "interflect/solver/methods/particles/random_walk.h"

#include <algorithm>
#include <cmath>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/error/noise_update.h"
#include "interflect/solver/importance/importance_weights.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/methods/particles/path_series.h"

namespace interflect::detail {

namespace {

/// Returns the estimate of a batch, with its variance for equal, independent contributions.
Estimate independent_contributions(const LightState& light, const BatchResult& batch) {
    const double power = luminance(integral(*light.forest, batch.irradiance));
    Estimate estimate{.irradiance = batch.irradiance, .escaped_power = batch.escaped};
    for (ElementIndex i{0}; i < batch.irradiance.size(); ++i)
        estimate.variance.push_back(static_cast<float>(luminance(batch.irradiance[i]) * power /
                                                       (static_cast<double>(batch.rays) * light.forest->area(i))));
    return estimate;
}

/// Returns the importance that controls the density of particles: psi of Eq. 10 or, with total_importance, of Eq. 9.
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

/// Returns the density beta + (1 - beta) psi, where psi is relative to its mean over emitted power.
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

WalkSource particles_of_light(const RunInputs& inputs, const LightState& light) {
    WalkSource walk_source = light_source(inputs, light);
    const std::vector<Rgb> of_patches(walk_source.emitted.begin(),
                                      walk_source.emitted.begin() + light.forest->patch_count());
    const std::vector<float> density = particle_density(light.solution, of_patches);
    // Luminaire parts keep the mean density 1, because their importance is unknown.
    std::copy(density.begin(), density.end(), walk_source.density.begin());
    return walk_source;
}

WalkSource importance_from_cameras(const RunInputs& inputs, const LightState& light) {
    WalkSource walk_source;
    walk_source.is_grey = true;
    for (PatchIndex i{0}; i < light.forest->patch_count(); ++i) {
        const float rho = inputs.materials.mean_reflectance(i);
        walk_source.emitted.emplace_back(rho * light.solution.view_importance[i] * light.forest->area(i));
        walk_source.reflectance.emplace_back(rho);
    }
    walk_source.density.assign(light.forest->patch_count(), 1.0f);
    return walk_source;
}

}  // namespace

RandomWalks::RandomWalks(const SolverState& state)
    : current_{{sub_key(state.light.options().seed, WalkPurpose::light)},
               {sub_key(state.light.options().seed, WalkPurpose::importance)}} {}

void RandomWalks::prepare(SolverState& state) {
    before_ = current_;
    current_.importance.batches = 0;
    current_.importance.pilot_rays = 0;
    current_.importance_history = 0;
    walk_importance(state, std::min(state.rays.schedule.start_rays(),
                                    missing_importance_rays(state, state.light.options().limits.rays)));
    state.rays.schedule.record_start(0, state.rays.importance);
}

std::int64_t RandomWalks::missing_importance_rays(const SolverState& state, std::int64_t planned) const {
    if (importance_use(state.light.solution) != ImportanceUse::full) return 0;
    const std::int64_t share = std::llround(state.light.options().experimental.alpha * static_cast<double>(planned));
    return std::max<std::int64_t>(0, share - current_.importance_history);
}

void RandomWalks::walk_importance(SolverState& state, std::int64_t rays) {
    if (rays <= 0) return;
    const BatchResult arrived =
        walk(state, importance_from_cameras(state.inputs, state.light), rays, current_.importance);
    state.rays.importance += arrived.rays;
    current_.importance_history += rays;
    const auto tau = static_cast<float>(static_cast<double>(rays) / static_cast<double>(current_.importance_history));
    std::vector<float>& psi = state.light.solution.indirect_importance;
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] += tau * (arrived.irradiance[i].x - psi[i]);
}

void RandomWalks::update_importance(SolverState& state, TracedIteration& iteration) {
    before_ = current_;
    iteration.importance_rays =
        std::min(iteration.plan.rays, missing_importance_rays(state, state.rays.schedule.rays() + iteration.plan.rays));
    const std::int64_t rays_before = state.rays.importance;
    walk_importance(state, iteration.importance_rays);
    iteration.rays = state.rays.importance - rays_before;
}

Estimate RandomWalks::trace(SolverState& state, TracedIteration& iteration) {
    Estimate estimate;
    if (iteration.plan.rays > iteration.importance_rays) {
        const BatchResult batch = walk(state, particles_of_light(state.inputs, state.light),
                                       iteration.plan.rays - iteration.importance_rays, current_.light);
        state.rays.power += batch.rays;
        iteration.rays += batch.rays;
        estimate = independent_contributions(state.light, batch);
    }
    if (iteration.rays == 0) iteration.rays = iteration.plan.rays;  // no visible surface reflects
    return estimate;
}

void RandomWalks::merge(SolverState& state, const Estimate& estimate, const TracedIteration& iteration) {
    if (estimate.irradiance.empty()) return;
    // The last iteration may be too small to estimate noise.
    const bool shows_error = iteration.weight >= state.rays.schedule.start_rays();
    if (shows_error) estimate_noise(state, estimate, iteration.weight);
    const double before = state.light.history[0], now = before + static_cast<double>(iteration.weight);
    const double tau = iteration.plan.warms_up ? 1 : static_cast<double>(iteration.weight) / now;  // Eq. 6
    for (ElementIndex i{0}; i < state.light.forest->size(); ++i)
        state.light.solution.irradiance[i] +=
            static_cast<float>(tau) * (estimate.irradiance[i] - state.light.solution.irradiance[i]);
    state.light.escaped_power += tau * (estimate.escaped_power - state.light.escaped_power);
    state.light.history.assign(state.light.history.size(), iteration.plan.warms_up ? 0.0f : static_cast<float>(now));
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
    for (const PathSeries& series : {current_.light, current_.importance}) require_valid(series, "random_walk");
}

std::unique_ptr<IterationMethod> make_random_walks(SolverState& state) { return std::make_unique<RandomWalks>(state); }

}  // namespace interflect::detail
