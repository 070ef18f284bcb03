#include "interflect/solver/run.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/light/group_light.h"

namespace interflect::detail {

Run::Run(std::shared_ptr<const Scene> s, std::shared_ptr<const RayCaster> caster, const SolveOptions& options)
    : undimmed_scene(std::move(s)),
      ray_caster(std::move(caster)),
      state(*undimmed_scene, *ray_caster, options),
      method(make_iteration_method(state)),
      known_dimming(state.inputs.groups.size(), 1) {}

void Run::dim_sources() {
    const bool is_dimmed = std::any_of(state.light.solution.dimming.begin(), state.light.solution.dimming.end(),
                                       [](float factor) { return factor != 1; });
    const std::shared_ptr<const Scene> before = scene;  // must outlive set_sources()
    scene =
        is_dimmed
            ? std::make_shared<const Scene>(dimmed(*undimmed_scene, state.inputs.groups, state.light.solution.dimming))
            : undimmed_scene;
    set_sources(state.inputs, state.light, *scene);
}

void Run::dim(std::size_t group, float factor) {
    Solution& solution = state.light.solution;
    const float change = factor > 0 ? factor / known_dimming[group] : 1;  // the stored light of a dark group is kept
    if (factor > 0) known_dimming[group] = factor;
    solution.dimming[group] = factor;
    for (Rgb& h : solution.groups[group]) h *= change;
    if (!solution.direct.empty())
        for (Rgb& h : solution.direct[group]) h *= change;
    solution.irradiance = sum_of(solution.groups, solution.dimming);
    dim_sources();
    state.light.escaped_power_rays = 0;  // unknown until the next iteration
}

Solution Run::snapshot() {
    Solution copy = state.light.solution;
    method->finish(state);
    std::swap(copy, state.light.solution);
    std::fill(copy.dimming.begin(), copy.dimming.end(), 1.0f);  // relative to the sources of `scene`
    const auto forest = std::make_shared<ElementForest>(*scene, state.light.forest->size());
    forest->rebuild(state.light.forest->subdivided());
    copy.forest = forest;
    return copy;
}

void Run::archive(StateArchive& archive) {
    state.archive(archive);
    method->archive(archive);
    if (archive.reads() && !method->is_consistent(state))
        throw std::runtime_error("the state of the run: arrays and elements differ in number");
    archive("is_prepared", is_prepared);
    archive("is_finished", is_finished);
    archive.unchecked("error", error);  // infinite if unknown
    StateArchive::require_range(error >= 0, "error");
    archive("iteration", iteration);
    archive.amounts("known_dimming", known_dimming);
    archive.amounts("dimming", state.light.solution.dimming);
    if (!archive.reads()) return;
    if (known_dimming.size() != state.inputs.groups.size() ||
        state.light.solution.dimming.size() != state.inputs.groups.size())
        throw std::runtime_error("the state of the run: expected the dimming of every light group");
    dim_sources();
}

}  // namespace interflect::detail
