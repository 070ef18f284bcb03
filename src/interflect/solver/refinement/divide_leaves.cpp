#include "interflect/solver/refinement/divide_leaves.h"

#include "interflect/elements/forest.h"

namespace interflect::detail {

void divide_leaves(SolverState& state, const std::vector<std::uint8_t>& splits) {
    ElementForest& forest = *state.light.forest;
    const std::uint32_t before = forest.size();
    for (ElementIndex e{0}; e < before && forest.size() + 4 <= state.light.options().refinement.max_elements; ++e)
        if (splits[e]) forest.subdivide(e);
    if (forest.size() == before) return;
    forest.put_in_order(before);
    grow_with_forest(state, before);
    for (ElementIndex e(before); e < forest.size(); e += 4) state.light.history.set(e, 0);
}

}  // namespace interflect::detail
