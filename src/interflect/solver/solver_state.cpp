#include "interflect/solver/solver_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/address_space.h"
#include "interflect/base/parallel.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/radiosity.h"
#include "interflect/solver/steps.h"

namespace interflect {

namespace {

/// A step of rays may make more elements than are kept at its end (Oracle::max_elements): addresses are reserved for
/// as many as no step of a second or two makes, or for what fits half of the addresses that the process may have.
std::size_t forest_capacity(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t largest = 0xfffffff0u, excess = std::size_t{1} << 26;
    constexpr std::size_t per_element = ElementForest::reserved_per_element + Arrivals::reserved_per_element;
    if (!options.method.refines) return scene.patches.size();
    if (options.method.scheme == Scheme::links) return options.max_elements;
    const std::size_t fitting = free_address_space() / 2 / per_element;
    return std::min(largest,
                    options.max_elements + std::min(excess, fitting - std::min(fitting, options.max_elements)));
}

V3f centre_of(const ElementForest& forest, std::uint32_t element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    return geometry.point(forest.cell(element).centre(geometry.is_triangle()));
}

}  // namespace

SolverState::SolverState(const Scene& scene, const RayCaster& caster, const SolveOptions& o, const Monitor& m)
    : materials(scene, caster),
      ray_caster(caster),
      options(o),
      monitor(m),
      forest(std::make_shared<ElementForest>(scene, forest_capacity(scene, o))),
      view(o.views, o.seed),
      floor(scene, o),
      streams(o.points, o.seed),
      arrivals(forest->capacity()),
      schedule(o, scene.patches.size()),
      noise(scene.patches.size()),
      stop(m.stop) {
    solution.forest = forest;
    solution.options = o;
    solution.irradiance.assign(forest->size(), Rgb(0, 0, 0));
    history.assign(forest->size(), 0.0f);
    solution.emitted_power = radiated_power(*forest, Radiosity(materials, solution.irradiance));
    view.trace_view_rays(*forest, caster, o.camera_rays);
    if (view.empty()) return;
    neighbourhoods = Neighbourhoods(*forest);
    solution.view_importance = view.per_area(*forest, !o.importance_at_elements);
    solution.indirect_importance.assign(forest->size(), 0.0f);
}

Received run_step(SolverState& state, TransportStep step) {
    const std::uint32_t before = state.forest->size();
    Received received = transport(state.materials, *state.forest, state.ray_caster, std::move(step), state.streams,
                                  state.arrivals, state.stop);
    state.escaped_rays += received.escaped_rays;
    if (state.forest->size() > before) grow_with_forest(state, before);
    return received;
}

float min_area(const SolverState& state, std::uint32_t element) {
    const std::uint32_t patch = state.forest->patch(element);
    const bool is_seen = !state.view.empty() && state.solution.view_importance[patch] > 0;
    return state.floor.min_area(centre_of(*state.forest, element), state.forest->geometry(patch).normal(), is_seen);
}

float pixel_area(const SolverState& state, std::uint32_t element) {
    const V3f normal = state.forest->geometry(state.forest->patch(element)).normal();
    return state.floor.pixel_area(centre_of(*state.forest, element), normal);
}

void grow_with_forest(SolverState& state, std::uint32_t first) {
    inherit(*state.forest, first, state.solution.irradiance);
    state.noise.grow(*state.forest, first);
    inherit(*state.forest, first, state.history);
    if (state.view.empty()) return;
    inherit(*state.forest, first, state.solution.indirect_importance);
    state.solution.view_importance = state.view.per_area(*state.forest, !state.options.importance_at_elements);
}

void refine_view_importance(SolverState& state) {
    constexpr std::int64_t rays_per_camera_ray = 64;
    if (state.view.empty()) return;
    const std::int64_t wanted =
        std::min<std::int64_t>(state.schedule.averaged_rays() / rays_per_camera_ray, most_camera_rays);
    if (wanted < 2 * state.view.rays()) return;
    state.view.trace_view_rays(*state.forest, state.ray_caster,
                               static_cast<int>((wanted - state.view.rays()) / state.view.views()));
    state.solution.view_importance = state.view.per_area(*state.forest, !state.options.importance_at_elements);
}

void report(SolverState& state, int iteration, const RgbD& escaped_power) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = state.seconds();
    r.rays = state.schedule.rays();
    r.power_rays = state.power_rays;
    r.importance_rays = state.importance_rays;
    r.escaped_rays = state.escaped_rays;
    r.elements = state.forest->size();
    r.leaves = state.forest->patch_count() + (r.elements - state.forest->patch_count()) / 4 * 3;
    r.total_power = radiated_power(*state.forest, Radiosity(state.materials, state.solution.irradiance));
    r.escaped_power = escaped_power;
    const SolutionError error = solution_error(state);
    r.error_estimate = error.total();
    r.noise_estimate = error.noise;
    r.discretisation_estimate = error.discretisation;
    constexpr double share_with_more = 0.001;
    r.largest_quantum = state.quanta.largest_over_mean();
    r.high_quantum = state.quanta.quantile_over_mean(share_with_more);
    state.solution.iterations.push_back(r);
    if (state.monitor.report) state.monitor.report(r);
}

}  // namespace interflect
