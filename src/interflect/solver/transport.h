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

/// Random numbers of a run. The sequence of each leaf continues through all iterations.
struct SampleStreams {
    SampleStreams(PointSet set, std::uint64_t run_seed) : points(set), seed(run_seed) {}

    PointSet points;
    std::uint64_t seed;
    std::vector<std::uint64_t> used;           ///< Points consumed by each element.
    std::vector<std::uint64_t> used_by_parts;  ///< Points consumed by each luminaire part.
    std::uint64_t allocations = 0;             ///< Number of steps so far.
};

/// One step of transport: sampling distribution of rays, their payload, and its receivers.
struct TransportStep {
    /// Weight >= 0 of each element (0 for inner ones), then of each part of `emission`. If all are 0, no rays are shot.
    std::vector<float> q;
    std::int64_t rays = 0;               ///< N > 0.
    Radiosity light;                     ///< Radiosity to shoot; empty: rays carry no power.
    const Emission* emission = nullptr;  ///< Luminaires that shoot, or null.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }
    GroupRadiosity groups;  ///< Light groups whose shares are received separately.
    /// True: rays carry B_s over the sum of its channels. False: B_s A_s / (N q_s), an unbiased estimate.
    bool equal_quanta = false;
    Importance importance;  ///< Importance psi to shoot; empty: rays carry none.
    bool carries_power() const { return !light.empty(); }
    bool carries_importance() const { return !importance.empty(); }
    Radiosity known_light;  ///< Radiosity for the oracle, shot or not; empty: `light`.
    const Radiosity& light_for_oracle() const { return known_light.empty() ? light : known_light; }
    bool importance_at_patches = false;  ///< Patches receive importance, not leaves.
    Oracle oracle;
    /// Random walks complete the transport of this power, which no later step reflects (Walks).
    bool to_the_end = false;
    /// Nonzero for leaves that reflect where they receive, or empty. Received::start_points contains their points.
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(std::uint32_t leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    const StartPoints* start_points = nullptr;  ///< Origins of `light`; null: uniform.
    /// Buffer to reuse after all rays are traced, such as that of `light`, or null.
    std::vector<Rgb>* spent = nullptr;
    /// Received values of inner elements stay 0. Not with a refining oracle.
    bool leaves_only = false;
};

/// Importance found by the rays of a luminaire part.
struct PartImportance {
    double found = 0;  ///< Sum over its rays [1/m^2]
    double rays = 0;
};

/// Results of a step by element of the (grown) forest. Inner elements have the mean of their children.
struct Received {
    std::vector<Rgb> irradiance;  ///< [lm/m^2 or W/m^2]
    /// Variance of its luminance for independent rays (Poisson).
    std::vector<float> variance;
    GroupLight groups;              ///< Shares of the light groups in `irradiance`.
    std::vector<float> importance;  ///< Importance per area; empty if not carried.
    /// Sum of rho psi at the hit points of each part's rays; empty if the step carries no importance.
    std::vector<PartImportance> part_importance;
    StartPoints start_points;  ///< Points on the leaves in reflecting_where_received.
    Quanta quanta;
    RgbD shot_power{0, 0, 0};  ///< Received plus escaped power [lm or W].
    RgbD escaped_power{0, 0, 0};
    std::int64_t escaped_rays = 0;
};

/// Estimates one bounce of power (Eq. 1, Prikryl et al. 2000) and importance (Eq. 7), without form factors. A ray
/// starts on leaf s with probability q_s / sum q, uniformly, in a cosine-distributed direction, or as its luminaire
/// emits. It deposits power A_s B_s / (N q_s) at element i and importance A_s rho_s psi_s / (N q_s) at the leaf that it
/// hits. Without refinement, i is this leaf. With refinement, the larger of two elements, initially the patches, is
/// divided until the oracle accepts the pair. On a fixed mesh the estimate is unbiased if q > 0 wherever the payload
/// is.
///
/// The paper's rays carry B_j, the mean over the accepted shooter j. If B and visibility vary together over j, this
/// loses or creates energy: 0.4% in a closed box. B_s keeps shot = received + escaped exactly.
/// @param forest    Grows if the oracle refines; indices of old elements do not change.
/// @param arrivals  Zero before and after; has the capacity of the forest.
/// @param streams   Advanced. The same streams give the same bits for any number of threads.
/// @throws Interrupted if `stop` is due before the last ray is traced. Forest, streams and arrivals are then unchanged.
///
/// Cost: O(N (log(patches) + levels)) on all threads; 40 bytes per element while rays are traced, then the results.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, Arrivals& arrivals, const StopRequest& stop);
/// The same without a stop request, and with its own Arrivals.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams);

/// Computes the variance of area-weighted means of independent elements, from the leaves up.
inline void pull_variance(const ElementForest& forest, std::vector<float>& variance) {
    forest.for_siblings_from_leaves([&](std::uint32_t first) {
        double sum = 0, area = 0;  // squared areas exceed the range of a float
        for (std::uint32_t e = first; e < first + 4; ++e) {
            const double part = forest.area(e);
            sum += variance[e] * part * part;
            area += part;
        }
        variance[forest.parent(first)] = static_cast<float>(sum / (area * area));
    });
}

/// Returns the rays of transport(), in its order.
std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams);

}  // namespace interflect::inline detail
