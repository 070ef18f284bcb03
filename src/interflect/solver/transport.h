#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/points.h"
#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/group_light.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/oracle.h"
#include "interflect/solver/quanta.h"
#include "interflect/solver/radiosity.h"
#include "interflect/solver/start_points.h"
#include "interflect/solver/stop_request.h"

namespace interflect::inline detail {

/// Random numbers of a run. Each leaf has its own sequence, which continues from iteration to iteration.
struct SampleStreams {
    SampleStreams(PointSet set, std::uint64_t run_seed) : points(set), seed(run_seed) {}

    PointSet points;
    std::uint64_t seed;
    std::vector<std::uint64_t> used;           ///< Points consumed by each element; grows with the forest.
    std::vector<std::uint64_t> used_by_parts;  ///< Points consumed by each luminaire part.
    std::uint64_t allocations = 0;             ///< Number of steps that have used these streams.
};

/// One step of transport: the sampling distribution of the rays, their payload, and its receivers.
struct TransportStep {
    /// Sampling weight of every element of the forest, >= 0, then of every part of `emission`. 0 for inner elements. If
    /// all are 0, no rays are shot.
    std::vector<float> q;
    std::int64_t rays = 0;               ///< N > 0.
    Radiosity light;                     ///< Radiosity to shoot; empty: rays carry no power.
    const Emission* emission = nullptr;  ///< Luminaires that shoot; null: none.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }
    GroupRadiosity groups;  ///< Light groups whose shares of power are received separately.
    /// True: each ray carries B_s over the sum of its channels. False: B_s A_s / (N q_s), an unbiased estimate.
    bool equal_quanta = false;
    Importance importance;  ///< psi to reflect and shoot; empty: rays carry no importance.
    bool carries_power() const { return !light.empty(); }
    bool carries_importance() const { return !importance.empty(); }
    Radiosity known_light;  ///< Radiosity seen by the oracle, shot in this step or not; empty: `light`.
    const Radiosity& light_for_oracle() const { return known_light.empty() ? light : known_light; }
    bool importance_at_patches = false;  ///< Patches receive importance, not leaves.
    Oracle oracle;
    /// Random walks complete the transport of the step's power: no later step reflects it (Walks).
    bool to_the_end = false;
    /// Nonzero for elements that reflect light where it was received; empty: none. The step returns these points
    /// (Received::start_points). All other leaves reflect uniformly.
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(std::uint32_t leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    const StartPoints* start_points = nullptr;  ///< Origins of `light`; null: uniform.
    /// Buffer to reuse for received irradiance after all rays are traced, such as the one that `light` refers to; may
    /// be null.
    std::vector<Rgb>* spent = nullptr;
    /// Received values of inner elements are not needed and stay 0. Not with a refining oracle.
    bool leaves_only = false;
};

/// Importance found by the rays of a luminaire part.
struct PartImportance {
    double found = 0;  ///< Sum over its rays [1/m^2].
    double rays = 0;
};

/// Result of one step for every element of the (grown) forest.
struct Received {
    std::vector<Rgb> irradiance;  ///< [lm/m^2 or W/m^2]; mean of the children for an inner element.
    /// Estimated variance of its luminance for independent rays (Poisson).
    std::vector<float> variance;
    GroupLight groups;              ///< Share of each light group in `irradiance`.
    std::vector<float> importance;  ///< Importance per area, averaged likewise; empty if not carried.
    /// For each luminaire part: its rays, and the sum of rho psi found at their hit points [1/m^2]. Empty if the step
    /// carries no importance.
    std::vector<PartImportance> part_importance;
    StartPoints start_points;     ///< Points on the leaves in reflecting_where_received.
    Quanta quanta;                ///< Power of the rays.
    RgbD shot_power{0, 0, 0};     ///< Power of all rays [lm or W]: received plus escaped.
    RgbD escaped_power{0, 0, 0};  ///< Power of the rays that hit nothing.
    std::int64_t escaped_rays = 0;
};

/// Estimates one bounce of power (Eq. 1, Prikryl et al. 2000) and importance (Eq. 7) for every element, without form
/// factors. A ray starts on leaf s with probability q_s / sum q, uniformly on s, in a cosine-distributed direction, or
/// as the luminaire emits. It deposits power A_s B_s / (N q_s) at element i, and importance A_s rho_s psi_s / (N q_s)
/// at the leaf that it hits. Without a refining oracle, i is this leaf. With one, the descent starts at the patches of
/// both ends. The larger end is subdivided, creating children on demand, until the oracle accepts the pair. On a fixed
/// mesh the estimate is unbiased if q is positive wherever the payload is.
///
/// The paper's rays carry B_j, the mean over the accepted shooter j. If B and visibility vary over j together, this
/// loses or creates energy: 0.4% in a closed box. B_s keeps shot = received + escaped exactly.
/// @param forest   Grows if the oracle subdivides; indices of old elements do not change.
/// @param arrivals  Zero before and after the step; has the capacity of the forest.
/// @param streams  Read and advanced. The same streams give the same bits for any number of threads.
/// @throws Interrupted if `stop` is due before the last ray is traced. The forest, the streams, the arrivals and the
/// data that the step refers to are then unchanged.
///
/// Cost: O(N (log(patches) + levels)) time on all threads; 40 bytes per element while rays are traced, then the
/// results.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, Arrivals& arrivals, const StopRequest& stop);
/// Same, without a stop request and with its own Arrivals.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams);

/// Computes the variance of area-weighted means of independent elements, from the leaves up.
inline void pull_variance(const ElementForest& forest, std::vector<float>& variance) {
    forest.for_siblings_from_leaves([&](std::uint32_t first) {
        double sum = 0, area = 0;  // squared areas may exceed the range of a float
        for (std::uint32_t e = first; e < first + 4; ++e) {
            const double part = forest.area(e);
            sum += variance[e] * part * part;
            area += part;
        }
        variance[forest.parent(first)] = static_cast<float>(sum / (area * area));
    });
}

/// Returns the rays that transport() would trace, in its order.
std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams);

}  // namespace interflect::inline detail
