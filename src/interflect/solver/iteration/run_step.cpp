#include "interflect/solver/iteration/run_step.h"

#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/transport/transport.h"

namespace interflect::detail {

Received run_step(SolverState& state, TransportStep step) {
    const std::uint32_t before = state.light.forest->size();
    step.importance_at_patches = state.light.options().experimental.importance_at_patches;
    Received received = transport(state.inputs.materials, *state.light.forest, state.inputs.ray_caster, std::move(step),
                                  state.sampling.streams, state.sampling.contributions, state.work.stop);
    state.rays.escaped += received.escaped_rays;
    for (std::size_t i = 0; i < received.part_importance.size(); ++i) {
        state.sampling.part_importance[i].found += received.part_importance[i].found;
        state.sampling.part_importance[i].rays += received.part_importance[i].rays;
    }
    if (state.light.forest->size() > before) grow_with_forest(state, before);
    return received;
}

}  // namespace interflect::detail
