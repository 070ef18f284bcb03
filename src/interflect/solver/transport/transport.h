#pragma once

#include <vector>

#include "interflect/base/sums/common_stop.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/deposit/transport_step.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/sampling/ray_maker.h"
#include "interflect/solver/transport/received.h"

namespace interflect::detail {

/// Estimates one bounce of power (Eq. 1, Prikryl et al. 2000) and importance (Eq. 7). A ray starts on leaf s with
/// probability q_s / sum q, at a uniform point in a cosine-distributed direction, or as its luminaire emits. It
/// deposits its Payload: importance on the hit leaf; power on the same leaf or, with refinement, on the element of a
/// pair that the oracle accepts. Unbiased on a fixed mesh if q > 0 wherever the payload is nonzero.
///
/// Rays carry the radiosity B_s of the leaf, not B_j of a larger element as in the paper (docs/method/method.md, One
/// step of transport). So shot power = received + escaped power, exactly.
/// @param forest   Grows if the oracle refines; old indices stay valid.
/// @param sums     Zero before and after the call; must have the capacity of the forest.
/// @param streams  Advanced by the used points. The same streams give the same bits for any number of threads.
/// @param stop     Its ranks share the rays, and all return the same result.
/// @throws Interrupted if `stop` is due before the last ray; forest, streams and sums are then unchanged.
/// Cost: O(N (log(patches) + levels)).
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, ContributionSums& sums, const CommonStop& stop);
/// Does the same with its own sums, and cannot be stopped.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams);

/// Returns the rays of transport(), in its order.
std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams);

}  // namespace interflect::detail
