#include "interflect/solver/state/solver_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/base/memory/address_space.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/light/radiosity.h"

namespace interflect::detail {

namespace {

/// Includes one or two seconds of new elements, since a step may create more than it keeps; at most half the free
/// address space.
std::size_t forest_capacity(const Scene& scene, const SolveOptions& options) {
    constexpr std::size_t largest = 0xfffffff0u, excess = std::size_t{1} << 26;
    const std::size_t groups = std::min(scene.light_groups.size() + 1, max_light_groups);
    const std::size_t per_element = ElementForest::reserved_per_element +
                                    ContributionSums::reserved_per_element(scene.light_groups.empty() ? 0 : groups);
    if (!options.method.refines) return scene.patches.size();
    if (!options.method.is_stochastic) return options.refinement.max_elements;  // never exceeded
    const std::size_t fitting = free_address_space() / 2 / per_element;
    return std::min(largest, options.refinement.max_elements +
                                 std::min(excess, fitting - std::min(fitting, options.refinement.max_elements)));
}

/// Power of the sources [lm or W], summed over the patches, so it does not depend on their elements. A resumed run,
/// whose elements exist from the beginning, has the same bits.
RgbD emitted_power(const SolverState& state) {
    const ElementForest& forest = *state.forest;
    const auto of_patches = [&](std::size_t begin, std::size_t end) {
        RgbD sum(0);
        for (auto patch = static_cast<std::uint32_t>(begin); patch < end; ++patch)
            sum += RgbD(state.materials.exitance(patch)) * static_cast<double>(forest.area(patch));
        return sum;
    };
    return parallel_sum(forest.patch_count(), elements_per_task, RgbD(0), of_patches) + state.emission.total_power();
}

V3f centre_of(const ElementForest& forest, std::uint32_t element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    return geometry.point(forest.cell(element).centre(geometry.is_triangle()));
}

}  // namespace

SolverState::SolverState(const Scene& s, const RayCaster& caster, const SolveOptions& o)
    : scene(s),
      materials(scene, caster),
      emission(scene),
      ray_caster(caster),
      groups(source_groups(scene)),
      forest(std::make_shared<ElementForest>(scene, forest_capacity(scene, o))),
      view(o.views, o.seed),
      floor(scene, o),
      streams(o.experimental.points, o.seed),
      contributions(forest->capacity(), groups.size()),
      schedule(o, scene.patches.size()),
      noise(scene.patches.size()) {
    solution.forest = forest;
    solution.options = o;
    solution.irradiance.assign(forest->size(), Rgb(0, 0, 0));
    solution.groups.assign(groups.size(), solution.irradiance);
    solution.group_names = groups.names;
    solution.dimming.assign(groups.size(), 1);
    history.assign(forest->size(), 0.0f);
    solution.emitted_power = emitted_power(*this);
    compute_view_importance(*this);
    if (o.experimental.shrinkage && o.experimental.clusters && refines_by_variance(o))
        clusters = cluster_patches(*forest, ray_caster);
}

void SolverState::begin_work(const Monitor& m) {
    monitor = m;
    stop = CommonStop(m.stop, m.ranks);
    start_of_this_call = StopRequest::Clock::now();
    reported_traffic = m.ranks ? m.ranks->traffic() : Ranks::Traffic();
}

void SolverState::end_work() {
    earlier_seconds = seconds();
    monitor = {};
    stop = {};
}

void set_sources(SolverState& state, const Scene& lit) {
    state.lit = &lit;
    state.materials = Materials(lit, state.ray_caster);
    state.materials.grow(*state.forest);
    state.emission = Emission(lit, state.targets);
    state.solution.emitted_power = emitted_power(state);
}

void set_targets(SolverState& state, std::vector<Imath::Box3f> targets) {
    state.targets = std::move(targets);
    state.emission = Emission(*state.lit, state.targets);
    state.part_importance.assign(state.emission.part_count(), {});
    std::vector<std::uint64_t>& used = state.streams.used_by_parts;
    used.resize(std::min(used.size(), state.emission.part_count()));
}

void compute_view_importance(SolverState& state) {
    if (state.targets.empty())
        state.part_importance.assign(state.emission.part_count(), {});
    else
        set_targets(state, {});
    state.view = ViewImportance(state.options.views, state.options.seed);
    state.floor = ElementFloor(state.scene, state.options);
    state.view.trace_view_rays(*state.forest, state.ray_caster, Panes(state.scene, state.ray_caster),
                               state.options.importance.camera_rays);
    state.solution.view_importance.clear();
    state.solution.indirect_importance.clear();
    state.rays_of_first_importance = 0;
    if (state.view.empty()) return;
    if (state.neighbourhoods.empty()) state.neighbourhoods = Neighbourhoods(*state.forest);
    state.solution.view_importance =
        state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
    state.solution.indirect_importance.assign(state.forest->size(), 0.0f);
}

GroupRadiosity group_radiosity(const SolverState& state, const GroupLight& irradiance, bool emits) {
    if (state.groups.empty()) return {};
    return {&state.groups, &irradiance, &state.solution.dimming, emits};
}

RgbD radiated_power(const SolverState& state) {
    return radiated_power(*state.forest, Radiosity(state.materials, state.solution.irradiance)) +
           state.emission.total_power();
}

bool refines_by_variance(const SolveOptions& o) {
    return o.method.refines && o.method.follows_variance && !o.experimental.one_bounce &&
           o.refinement.criterion != RefinementCriterion::power;
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
    inherit(*state.forest, first, state.solution.groups);
    inherit(*state.forest, first, state.solution.direct);
    state.noise.grow(*state.forest, first);
    state.materials.grow(*state.forest);
    inherit(*state.forest, first, state.history);
    if (state.view.empty()) return;
    inherit(*state.forest, first, state.solution.indirect_importance);
    state.solution.view_importance =
        state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
}

void refine_view_importance(SolverState& state) {
    constexpr std::int64_t rays_per_camera_ray = 64;
    if (state.view.empty()) return;
    const std::int64_t wanted =
        std::min<std::int64_t>(state.schedule.averaged_rays() / rays_per_camera_ray, max_camera_rays);
    if (wanted < 2 * state.view.rays()) return;
    state.view.trace_view_rays(*state.forest, state.ray_caster, Panes(state.scene, state.ray_caster),
                               static_cast<int>((wanted - state.view.rays()) / state.view.views()));
    state.solution.view_importance =
        state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
}

}  // namespace interflect::detail
