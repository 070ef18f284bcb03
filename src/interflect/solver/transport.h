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

/// Random numbers of a run. The sequence of each leaf continues over all iterations.
struct SampleStreams {
    SampleStreams(PointSet set, std::uint64_t run_seed) : points(set), seed(run_seed) {}

    PointSet points;
    std::uint64_t seed;
    std::vector<std::uint64_t> used;           ///< points, by element
    std::vector<std::uint64_t> used_by_parts;  ///< points, by luminaire part
    std::uint64_t allocations = 0;             ///< number of steps
};

/// Sampling distribution of rays, their payload, and its receivers.
struct TransportStep {
    /// Weight >= 0 by element (0 for inner ones), then by part of `emission`. All 0: no rays.
    std::vector<float> q;
    std::int64_t rays = 0;               ///< N > 0.
    Radiosity light;                     ///< to shoot; empty: no power
    const Emission* emission = nullptr;  ///< luminaires that shoot; null: none
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }
    GroupRadiosity groups;  ///< received separately
    /// True: payload B_s over the sum of its channels. False: B_s A_s / (N q_s), an unbiased estimate.
    bool equal_quanta = false;
    Importance importance;  ///< psi to shoot; empty: no importance
    bool carries_power() const { return !light.empty(); }
    bool carries_importance() const { return !importance.empty(); }
    Radiosity known_light;  ///< for the oracle, shot or not; empty: `light`
    const Radiosity& light_for_oracle() const { return known_light.empty() ? light : known_light; }
    bool importance_at_patches = false;  ///< else at leaves
    Oracle oracle;
    /// Random walks complete the transport of this power, which no later step reflects (Walks).
    bool to_the_end = false;
    /// Nonzero for leaves that reflect where they receive; empty: none. The step returns the points
    /// (Received::start_points).
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(std::uint32_t leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    const StartPoints* start_points = nullptr;  ///< origins of `light`; null: uniform
    /// Buffer to reuse after all rays are traced, such as that of `light`; may be null.
    std::vector<Rgb>* spent = nullptr;
    /// Inner elements stay 0. Not with a refining oracle.
    bool leaves_only = false;
};

struct PartImportance {
    double found = 0;  ///< sum over its rays [1/m^2]
    double rays = 0;
};

/// By element of the (grown) forest; inner elements have the mean of their children.
struct Received {
    std::vector<Rgb> irradiance;  ///< [lm/m^2 or W/m^2]
    /// Of its luminance, for independent rays (Poisson).
    std::vector<float> variance;
    GroupLight groups;              ///< shares in `irradiance`
    std::vector<float> importance;  ///< per area; empty if not carried
    /// Sum of rho psi at the hit points of a part's rays; empty if the step carries no importance.
    std::vector<PartImportance> part_importance;
    StartPoints start_points;  ///< on the leaves in reflecting_where_received
    Quanta quanta;
    RgbD shot_power{0, 0, 0};  ///< [lm or W]: received plus escaped
    RgbD escaped_power{0, 0, 0};
    std::int64_t escaped_rays = 0;
};

/// Estimates one bounce of power (Eq. 1, Prikryl et al. 2000) and importance (Eq. 7), without form factors. A ray
/// starts on leaf s with probability q_s / sum q, uniformly, in a cosine-distributed direction, or as its luminaire
/// emits. It deposits power A_s B_s / (N q_s) at element i, and importance A_s rho_s psi_s / (N q_s) at the leaf hit.
/// Without refinement, i is this leaf. With it, the larger of two elements, initially the patches, is divided until the
/// oracle accepts the pair. The estimate is unbiased on a fixed mesh if q > 0 wherever the payload is.
///
/// The paper's rays carry B_j, the mean over the accepted shooter j. If B and visibility vary together over j, this
/// loses or creates energy: 0.4% in a closed box. B_s keeps shot = received + escaped exactly.
/// @param forest    Grows if the oracle refines; old indices stay.
/// @param arrivals  Zero before and after; for the capacity of the forest.
/// @param streams   Advanced. The same streams give the same bits for any number of threads.
/// @throws Interrupted if `stop` is due before the last ray is traced; restores all arguments.
///
/// Cost: O(N (log(patches) + levels)) on all threads; 40 bytes per element while rays are traced, then the results.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, Arrivals& arrivals, const StopRequest& stop);
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams);

/// Variance of area-weighted means of independent elements, from the leaves up.
inline void pull_variance(const ElementForest& forest, std::vector<float>& variance) {
    forest.for_siblings_from_leaves([&](std::uint32_t first) {
        double sum = 0, area = 0;  // squared areas exceed a float
        for (std::uint32_t e = first; e < first + 4; ++e) {
            const double part = forest.area(e);
            sum += variance[e] * part * part;
            area += part;
        }
        variance[forest.parent(first)] = static_cast<float>(sum / (area * area));
    });
}

/// In the order of transport().
std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams);

}  // namespace interflect::inline detail
