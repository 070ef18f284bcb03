#include "interflect/solver/iteration/iteration_start.h"

#include <utility>

#include "interflect/elements/forest.h"

namespace interflect::detail {

IterationStart::IterationStart(SolverState& state)
    : state_(state),
      elements_(state.light.forest->size()),
      streams_(state.sampling.streams),
      targets_(state.inputs.targets),
      part_importance_(state.sampling.part_importance),
      power_rays_(state.rays.power),
      importance_rays_(state.rays.importance),
      escaped_rays_(state.rays.escaped),
      non_finite_(state.light.solution.non_finite),
      payloads_(state.sampling.payloads),
      reports_(state.light.solution.iterations.size()) {
    state.sampling.importance_at_start = state.light.solution.indirect_importance;
}

IterationStart::~IterationStart() { state_.sampling.importance_at_start = std::vector<float>(); }

void IterationStart::restore() {
    SolverState& state = state_;
    Solution& solution = state.light.solution;
    if (state.light.forest->size() > elements_) {
        while (state.light.forest->size() > elements_) state.light.forest->drop_last_siblings();
        solution.irradiance.resize(elements_);
        for (GroupLight* light : {&solution.groups, &solution.direct})
            for (std::vector<Rgb>& of_group : *light) of_group.resize(elements_);
        state.light.history.resize(elements_);
        state.light.noise.shrink(elements_);
        state.sampling.view.shrink(elements_);
        state.inputs.materials = Materials(*state.inputs.lit, state.inputs.ray_caster);
        state.inputs.materials.grow(*state.light.forest);
    }
    if (!state.sampling.view.empty() && solution.view_importance.size() != elements_)
        set_view_importance(state.light, state.sampling);
    if (state.inputs.targets != targets_) set_targets(state.inputs, state.sampling, targets_);
    state.sampling.part_importance = part_importance_;
    state.sampling.streams = streams_;
    solution.indirect_importance = std::move(state.sampling.importance_at_start);
    state.rays.power = power_rays_;
    state.rays.importance = importance_rays_;
    state.rays.escaped = escaped_rays_;
    solution.non_finite = non_finite_;
    state.sampling.payloads = payloads_;
    solution.iterations.resize(reports_);
}

}  // namespace interflect::detail
