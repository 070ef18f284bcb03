#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/base/points.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/solver/surfaces.h"

namespace interflect {

/// The random numbers of a run: each patch draws from a sequence of its own, which goes on from iteration to iteration.
struct SampleStreams {
    SampleStreams(PointSet set, std::uint64_t run_seed, std::size_t patches)
        : points(set), seed(run_seed), used(patches, 0) {}

    PointSet points;
    std::uint64_t seed;
    std::vector<std::uint64_t> used;  ///< Points that each patch has consumed.
    std::uint64_t allocations = 0;    ///< Calls that have drawn from these streams.
};

/// Splits N rays systematically: patch s gets the rays first[s] ... first[s + 1] - 1, their number N q_s rounded up or
/// down, N q_s in the mean over `offset`.
/// @param q       Sampling weights >= 0, not all 0; they need not sum to 1.
/// @param offset  Uniform in [0, 1).
/// @return        `first`, size q.size() + 1, first[0] = 0, last = N; patches of weight 0 get no ray.
std::vector<std::int64_t> allocate_rays(std::span<const double> q, std::int64_t ray_count, double offset);

/// q of Eq. 3, Prikryl et al. 2000: in proportion to power, all channels together; 0 where it is not finite.
std::vector<double> power_weights(std::span<const Rgb> power);

/// What one transport step brought.
struct Received {
    std::vector<Rgb> power;       ///< R_i of each patch [lm or W].
    RgbD shot_power{0, 0, 0};     ///< What all rays carried together.
    RgbD escaped_power{0, 0, 0};  ///< What the rays that hit nothing carried.
    std::int64_t escaped_rays = 0;
    std::int64_t non_finite = 0;  ///< Patches whose power was not finite and was not shot.
};

/// Estimates the power that every patch receives in one bounce, R_i = sum_s F_si P_s (in Eq. 1, Prikryl et al. 2000),
/// without any form factor: a ray starts on patch s with probability q_s / sum q, uniformly on s, in a
/// cosine-distributed direction, and brings P_s / (N q_s) to the patch it hits. Unbiased for every q that is positive
/// wherever P is.
/// @param power      P_s of each patch [lm or W], linear RGB; size surfaces.size(), >= 0.
/// @param q          Sampling weights, as in allocate_rays; all 0 shoots nothing.
/// @param ray_count  N > 0.
/// @param streams    Read and advanced. The same streams give the same bits for any number of threads.
/// Cost: O(N log(patches)) time on all threads, 24 bytes a patch.
Received receive_power(const Surfaces& surfaces, const RayCaster& ray_caster, std::span<const Rgb> power,
                       std::span<const double> q, std::int64_t ray_count, SampleStreams& streams);

/// The rays that receive_power would trace with these arguments, in its order; q not all 0.
std::vector<Ray> transport_rays(const Surfaces& surfaces, const RayCaster& ray_caster, std::span<const double> q,
                                std::int64_t ray_count, const SampleStreams& streams);

}  // namespace interflect
