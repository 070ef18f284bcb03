#include "interflect/solver/run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/address_space.h"
#include "interflect/base/parallel.h"
#include "interflect/solver/detail.h"
#include "interflect/solver/light.h"
#include "interflect/solver/steps.h"

namespace interflect {

namespace {

/// A step of rays may make more elements than are kept at its end (Oracle::most_elements): addresses are reserved for
/// as many as no step of a second or two makes, or for what fits half of the addresses that the process may have.
std::size_t forest_capacity(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t largest = 0xfffffff0u, excess = std::size_t{1} << 26;
    constexpr std::size_t per_element = ElementForest::reserved_per_element + Arrivals::reserved_per_element;
    if (!options.method.refines) return scene.patches.size();
    if (options.method.scheme == Scheme::links) return options.most_elements;
    const std::size_t fitting = free_address_space() / 2 / per_element;
    return std::min(largest,
                    options.most_elements + std::min(excess, fitting - std::min(fitting, options.most_elements)));
}

V3f centre_of(const ElementForest& forest, std::uint32_t element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    return geometry.point(forest.cell(element).centre(geometry.is_triangle()));
}

}  // namespace

Run::Run(const Scene& scene, const RayCaster& caster, const SolveOptions& o, const Monitor& m)
    : surfaces(scene, caster),
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
    solution.emitted_power = radiated_power(*forest, Light(surfaces, solution.irradiance));
    view.look(*forest, caster, o.eye_rays);
    if (view.empty()) return;
    neighbourhoods = Neighbourhoods(*forest);
    solution.view_importance = view.per_area(*forest, !o.importance_at_elements);
    solution.indirect_importance.assign(forest->size(), 0.0f);
}

Received run_step(Run& run, TransportStep step) {
    const std::uint32_t before = run.forest->size();
    Received received =
        transport(run.surfaces, *run.forest, run.ray_caster, std::move(step), run.streams, run.arrivals, run.stop);
    run.escaped_rays += received.escaped_rays;
    if (run.forest->size() > before) grow_with_forest(run, before);
    return received;
}

float smallest_area(const Run& run, std::uint32_t element) {
    const std::uint32_t patch = run.forest->patch(element);
    const bool is_seen = !run.view.empty() && run.solution.view_importance[patch] > 0;
    return run.floor.smallest_area(centre_of(*run.forest, element), run.forest->geometry(patch).normal(), is_seen);
}

float pixel_area(const Run& run, std::uint32_t element) {
    const V3f normal = run.forest->geometry(run.forest->patch(element)).normal();
    return run.floor.pixel_area(centre_of(*run.forest, element), normal);
}

void grow_with_forest(Run& run, std::uint32_t first) {
    inherit(*run.forest, first, run.solution.irradiance);
    run.noise.grow(*run.forest, first);
    inherit(*run.forest, first, run.history);
    if (run.view.empty()) return;
    inherit(*run.forest, first, run.solution.indirect_importance);
    run.solution.view_importance = run.view.per_area(*run.forest, !run.options.importance_at_elements);
}

void look_closer(Run& run) {
    constexpr std::int64_t rays_per_eye_ray = 64;
    if (run.view.empty()) return;
    const std::int64_t wanted = std::min<std::int64_t>(run.schedule.averaged_rays() / rays_per_eye_ray, most_eye_rays);
    if (wanted < 2 * run.view.rays()) return;
    run.view.look(*run.forest, run.ray_caster, static_cast<int>((wanted - run.view.rays()) / run.view.views()));
    run.solution.view_importance = run.view.per_area(*run.forest, !run.options.importance_at_elements);
}

void report(Run& run, int iteration, const RgbD& escaped_power) {
    IterationReport r;
    r.iteration = iteration;
    r.seconds = run.seconds();
    r.rays = run.schedule.rays();
    r.power_rays = run.power_rays;
    r.importance_rays = run.importance_rays;
    r.escaped_rays = run.escaped_rays;
    r.elements = run.forest->size();
    r.leaves = run.forest->patch_count() + (r.elements - run.forest->patch_count()) / 4 * 3;
    r.total_power = radiated_power(*run.forest, Light(run.surfaces, run.solution.irradiance));
    r.escaped_power = escaped_power;
    const SolutionError error = solution_error(run);
    r.error_estimate = error.total();
    r.noise_estimate = error.noise;
    r.discretisation_estimate = error.discretisation;
    constexpr double share_with_more = 0.001;
    r.largest_quantum = run.quanta.largest_over_mean();
    r.high_quantum = run.quanta.quantile_over_mean(share_with_more);
    run.solution.iterations.push_back(r);
    if (run.monitor.report) run.monitor.report(r);
}

}  // namespace interflect
