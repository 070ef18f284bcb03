#include "interflect/solver/iteration/run_step.h"

#include <utility>

#include "interflect/elements/forest.h"
#include "interflect/solver/transport/transport.h"

namespace interflect::detail {

Received run_step(SolverState& state, TransportStep step) {
    const std::uint32_t before = state.forest->size();
    step.importance_at_patches = state.options.experimental.importance_at_patches;
    Received received = transport(state.materials, *state.forest, state.ray_caster, std::move(step), state.streams,
                                  state.contributions, state.stop);
    state.escaped_rays += received.escaped_rays;
    for (std::size_t i = 0; i < received.part_importance.size(); ++i) {
        state.part_importance[i].found += received.part_importance[i].found;
        state.part_importance[i].rays += received.part_importance[i].rays;
    }
    if (state.forest->size() > before) grow_with_forest(state, before);
    return received;
}

}  // namespace interflect::detail
