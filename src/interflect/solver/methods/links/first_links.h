#pragma once

#include <cstddef>
#include <vector>

#include "interflect/solver/methods/links/cluster_exchange.h"
#include "interflect/solver/methods/links/exchange.h"
#include "interflect/solver/methods/links/patch_tree.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

struct LinkCandidate {
    ElementPair ends;
    Effort effort;
};

/// Returns the patches to be grouped into clusters; none without ExperimentalOptions::clusters. Emitters are not
/// grouped and keep one link to each patch, for accurate direct light.
std::vector<PatchIndex> patches_to_cluster(const RunInputs& inputs, const LightState& light);

/// Returns all pairs of patches that face each other; stops beyond `limit`.
std::vector<LinkCandidate> pairs_of_patches(const SolverState& state, const ExchangeEstimator& estimator,
                                            std::size_t limit);

/// Returns pairs of clusters or patches that cover all pairs of patches that face each other; stops beyond `limit`.
std::vector<LinkCandidate> pairs_of_clusters(const RunInputs& inputs, const LightState& light,
                                             const ExchangeEstimator& estimator, const PatchTree& tree,
                                             const ClusterExchange& exchange, std::size_t limit);

}  // namespace interflect::detail
