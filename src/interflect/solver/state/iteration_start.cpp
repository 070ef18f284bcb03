#include "interflect/solver/state/iteration_start.h"

#include "interflect/elements/forest.h"

namespace interflect::detail {

IterationStart::IterationStart(const SolverState& state)
    : elements_(state.forest->size()),
      streams_(state.streams),
      targets_(state.targets),
      part_importance_(state.part_importance),
      indirect_importance_(state.solution.indirect_importance),
      power_rays_(state.power_rays),
      importance_rays_(state.importance_rays),
      escaped_rays_(state.escaped_rays),
      non_finite_(state.solution.non_finite),
      payloads_(state.payloads),
      reports_(state.solution.iterations.size()) {}

void IterationStart::restore(SolverState& state) const {
    Solution& solution = state.solution;
    if (state.forest->size() > elements_) {
        while (state.forest->size() > elements_) state.forest->drop_last_siblings();
        solution.irradiance.resize(elements_);
        for (GroupLight* light : {&solution.groups, &solution.direct})
            for (std::vector<Rgb>& of_group : *light) of_group.resize(elements_);
        state.history.resize(elements_);
        state.noise.shrink(elements_);
        state.view.shrink(elements_);
        state.materials = Materials(*state.lit, state.ray_caster);
        state.materials.grow(*state.forest);
        if (!state.view.empty())
            solution.view_importance =
                state.view.per_area(*state.forest, state.options.experimental.importance_at_patches);
    }
    if (state.targets != targets_) set_targets(state, targets_);
    state.part_importance = part_importance_;
    state.streams = streams_;
    solution.indirect_importance = indirect_importance_;
    state.power_rays = power_rays_;
    state.importance_rays = importance_rays_;
    state.escaped_rays = escaped_rays_;
    solution.non_finite = non_finite_;
    state.payloads = payloads_;
    solution.iterations.resize(reports_);
}

}  // namespace interflect::detail
