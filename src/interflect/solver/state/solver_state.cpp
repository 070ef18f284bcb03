#include "interflect/solver/state/solver_state.h"

#include <algorithm>
#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/raycast/panes.h"

namespace interflect::detail {

namespace {

void trace_view_rays(const RunInputs& inputs, const ElementForest& forest, ViewImportance& view, int rays_per_view) {
    view.trace_view_rays(forest, inputs.ray_caster, Panes(inputs.scene, inputs.ray_caster), rays_per_view);
}

void set_cluster_pixels(RunInputs& inputs, const LightState& light) {
    inputs.cluster_pixels.clear();
    if (inputs.clusters.empty() || light.options().views.empty()) return;
    inputs.cluster_pixels = inputs.clusters.front().sums<double>(
        [&](PatchIndex p) { return light.forest->area(p) / pixel_area(inputs, light, p); });
}

}  // namespace

RunInputs::RunInputs(const Scene& s, const RayCaster& caster, const SolveOptions& options)
    : scene(s),
      ray_caster(caster),
      groups(source_groups(scene)),
      materials(scene, caster),
      emission(scene),
      element_floor(scene, options) {}

SamplingState::SamplingState(const RunInputs& inputs, const LightState& light)
    : view(light.options().views, light.options().seed),
      streams(light.options().experimental.points, light.options().seed),
      contributions(light.forest->capacity(), inputs.groups.size()) {}

SolverState::SolverState(const Scene& scene, const RayCaster& caster, const SolveOptions& options)
    : inputs(scene, caster, options),
      light(inputs, options),
      sampling(inputs, light),
      rays{.schedule = Schedule(options, scene.patches.size())} {
    compute_view_importance(*this);
    if (options.experimental.shrinkage && options.experimental.clusters && refines_by_variance(options))
        inputs.clusters = cluster_patches(*light.forest, caster);
    set_cluster_pixels(inputs, light);
}

void set_targets(RunInputs& inputs, SamplingState& sampling, std::vector<Imath::Box3f> targets) {
    inputs.targets = std::move(targets);
    inputs.emission = Emission(*inputs.lit, inputs.targets);
    sampling.part_importance.assign(inputs.emission.part_count(), {});
    std::vector<std::uint64_t>& used = sampling.streams.used_by_parts;
    used.resize(std::min(used.size(), inputs.emission.part_count()));
}

void set_view_importance(LightState& light, SamplingState& sampling) {
    light.solution.view_importance =
        sampling.view.per_area(*light.forest, light.options().experimental.importance_at_patches);
}

void compute_view_importance(SolverState& state) {
    RunInputs& inputs = state.inputs;
    LightState& light = state.light;
    SamplingState& sampling = state.sampling;
    Solution& solution = light.solution;
    if (inputs.targets.empty())
        sampling.part_importance.assign(inputs.emission.part_count(), {});
    else
        set_targets(inputs, sampling, {});
    sampling.view = ViewImportance(light.options().views, light.options().seed);
    inputs.element_floor = ElementFloor(inputs.scene, light.options());
    set_cluster_pixels(inputs, light);
    trace_view_rays(inputs, *light.forest, sampling.view, light.options().importance.camera_rays);
    solution.view_importance.clear();
    solution.indirect_importance.clear();
    state.rays.of_first_importance = 0;
    if (sampling.view.empty()) return;
    if (sampling.neighbourhoods.empty()) sampling.neighbourhoods = Neighbourhoods(*light.forest);
    set_view_importance(light, sampling);
    solution.indirect_importance.assign(light.forest->size(), 0.0f);
}

void refine_view_importance(SolverState& state) {
    constexpr std::int64_t rays_per_camera_ray = 64;
    ViewImportance& view = state.sampling.view;
    if (view.empty()) return;
    const std::int64_t wanted =
        std::min<std::int64_t>(state.rays.schedule.averaged_rays() / rays_per_camera_ray, max_camera_rays);
    if (wanted < 2 * view.rays()) return;
    trace_view_rays(state.inputs, *state.light.forest, view, static_cast<int>((wanted - view.rays()) / view.views()));
    set_view_importance(state.light, state.sampling);
}

void grow_with_forest(SolverState& state, std::uint32_t first) {
    LightState& light = state.light;
    const ElementForest& forest = *light.forest;
    inherit(forest, first, light.solution.irradiance);
    inherit(forest, first, light.solution.groups);
    inherit(forest, first, light.solution.direct);
    light.noise.grow(forest, first);
    state.inputs.materials.grow(forest);
    light.history.grow(forest, first);
    if (state.sampling.view.empty()) return;
    inherit(forest, first, light.solution.indirect_importance);
    set_view_importance(light, state.sampling);
}

}  // namespace interflect::detail
