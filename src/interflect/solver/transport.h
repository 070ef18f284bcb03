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

/// The random numbers of a run: each leaf draws from a sequence of its own, which goes on from iteration to iteration.
struct SampleStreams {
    SampleStreams(PointSet set, std::uint64_t run_seed) : points(set), seed(run_seed) {}

    PointSet points;
    std::uint64_t seed;
    std::vector<std::uint64_t> used;           ///< Points that each element has consumed; grows with the forest.
    std::vector<std::uint64_t> used_by_parts;  ///< The same of parts of the luminaires.
    std::uint64_t allocations = 0;             ///< Steps that have drawn from these streams.
};

/// One step of transport: which rays start where, what they carry, and where it is received.
struct TransportStep {
    /// Sampling weight of every element of the forest, >= 0, then of every part of `emission`; 0 for elements that are
    /// not leaves. All 0 shoots nothing.
    std::vector<float> q;
    std::int64_t rays = 0;               ///< N > 0.
    Radiosity light;                     ///< What leaves the elements, to be shot; empty: rays carry no power.
    const Emission* emission = nullptr;  ///< Luminaires that shoot too; null: none do.
    std::size_t part_count() const { return emission ? emission->part_count() : 0; }
    GroupRadiosity groups;  ///< Light groups whose shares of the power are received apart.
    /// Of power every ray carries B_s over the sum of its channels, wherever it starts. False: B_s A_s / (N q_s), which
    /// makes the estimate unbiased.
    bool equal_quanta = false;
    Importance importance;  ///< psi, as it is reflected and shot on; empty: rays carry none.
    bool carries_power() const { return !light.empty(); }
    bool carries_importance() const { return !importance.empty(); }
    Radiosity
        known_light;  ///< What the oracle takes to leave the elements, be it shot in this step or not; empty: `light`.
    const Radiosity& light_for_oracle() const { return known_light.empty() ? light : known_light; }
    bool importance_at_patches = false;  ///< Importance is received by whole patches, not by leaves.
    Oracle oracle;
    /// Random walks complete the transport of the step's power: no later step reflects it (Walks).
    bool to_the_end = false;
    /// Nonzero for each element that reflects light where it was received; empty: no element does. The step returns
    /// these points (Received::start_points); all other leaves reflect uniformly.
    std::span<const std::uint8_t> reflecting_where_received;
    bool reflects_where_received(std::uint32_t leaf) const {
        return !reflecting_where_received.empty() && reflecting_where_received[leaf] != 0;
    }
    const StartPoints* start_points = nullptr;  ///< Origins of `light`; null: uniform.
    /// Storage that what is received may take once all rays are traced, such as that of what `light` refers to; may be
    /// null.
    std::vector<Rgb>* spent = nullptr;
    /// What inner elements receive is of no interest: it stays 0. Not with an oracle that refines.
    bool leaves_only = false;
};

/// Importance that the rays of a part of a luminaire have found.
struct PartImportance {
    double found = 0;  ///< Sum over its rays [1/m^2].
    double rays = 0;
};

/// What one step brought, for every element of the (grown) forest.
struct Received {
    std::vector<Rgb> irradiance;  ///< [lm/m^2 or W/m^2]; an inner element has the mean of its children.
    /// Estimated variance of the luminance of that: as if rays arrived independently of each other (Poisson).
    std::vector<float> variance;
    GroupLight groups;              ///< Of the irradiance what each light group brought.
    std::vector<float> importance;  ///< Importance per area, likewise; empty unless the step carried it.
    /// Of every part of the luminaires, empty unless the step carried importance: its rays, and the sum of the
    /// importance per area, rho psi, that they found where they arrived.
    std::vector<PartImportance> part_importance;
    StartPoints start_points;     ///< Points on the leaves in reflecting_where_received.
    Quanta quanta;                ///< What its rays carried, one by one.
    RgbD shot_power{0, 0, 0};     ///< What all rays carried together [lm or W]: the sum of what arrived and escaped.
    RgbD escaped_power{0, 0, 0};  ///< What the rays that hit nothing carried.
    std::int64_t escaped_rays = 0;
};

/// Estimates what every element receives in one bounce of Eq. 1 (power) and Eq. 7 (importance), Prikryl et al. 2000,
/// without any form factor. A ray starts on leaf s with probability q_s / sum q, uniformly on s, in a
/// cosine-distributed direction, or as the luminaire emits; it brings B_s A_s / (N q_s) of power to element i, and
/// rho_s psi_s A_s / (N q_s) of importance to the leaf that it hits. Without a refining oracle i is the leaf that is
/// hit; with one, the search starts at the patches of both ends and the larger side is subdivided until the oracle
/// accepts the pair, making children where there are none. The paper's rays carry B_j, the mean over the accepted
/// shooter j; that loses or makes energy wherever B varies over j together with what j sees, 0.4% in a closed box,
/// while B_s keeps shot = received + escaped exactly. Unbiased on a fixed mesh for every q that is positive wherever
/// what is carried is.
/// @param forest   Grows when the oracle asks for it; the numbers of its old elements stay.
/// @param arrivals  Nothing has arrived yet, and nothing has afterwards: for as many elements as the forest may have.
/// @param streams  Read and advanced. The same streams give the same bits for any number of threads.
/// @throws Interrupted where `stop` is due before the last ray is traced; the forest, the streams, the arrivals and
/// what the step refers to are then as before.
///
/// Cost: O(N (log(patches) + levels)) time on all threads; 32 bytes an element while rays arrive, then what is
/// received.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams, Arrivals& arrivals, const StopRequest& stop);
/// The same, to its end, with arrivals of its own.
Received transport(const Materials& materials, ElementForest& forest, const RayCaster& ray_caster, TransportStep step,
                   SampleStreams& streams);

/// The variance of the area-weighted mean of elements whose values are independent, from the leaves up.
inline void pull_variance(const ElementForest& forest, std::vector<float>& variance) {
    forest.for_siblings_from_leaves([&](std::uint32_t first) {
        double sum = 0, area = 0;  // squares of areas soon leave the range of a float
        for (std::uint32_t e = first; e < first + 4; ++e) {
            const double part = forest.area(e);
            sum += variance[e] * part * part;
            area += part;
        }
        variance[forest.parent(first)] = static_cast<float>(sum / (area * area));
    });
}

/// The rays that transport() would trace, in its order.
std::vector<Ray> transport_rays(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
                                const SampleStreams& streams);

}  // namespace interflect::inline detail
