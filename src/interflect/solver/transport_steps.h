#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/solve.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/neighbourhoods.h"
#include "interflect/solver/transport.h"

namespace interflect::inline detail {

/// Returns the use of importance by the method; off without a view.
ImportanceUse importance_use(const Solution& so_far);

/// Whether variance refines the mesh between passes.
bool refines_by_variance(const SolveOptions& options);

/// Returns psi of every element, empty without a view. Refers to the solution.
Importance importance_of(const Solution& so_far);
std::vector<float> total_importance(const Solution& so_far);

/// Importance for sampling rays of power; empty if not used.
struct ImportanceWeights {
    std::vector<float> elements;
    std::vector<float> nearby;               ///< Neighbourhood importance by patch; empty without smoothing.
    std::vector<float> parts, parts_nearby;  ///< The same for luminaire parts.
};
/// @param found  Importance found by rays of luminaire parts so far.
ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission = {}, const std::vector<PartImportance>& found = {});

/// A step, with the sums over leaves of P_s (Eq. 3) and of P_s times sampling importance (Eq. 9, 10; 0 if not used).
struct PowerStep {
    TransportStep step;
    double power = 0, weighted_power = 0;
    std::int64_t lost_leaves = 0;  ///< Leaves with non-finite radiosity, which are not shot.
};

/// Makes a step with power and, if `combined`, importance (Eq. 11, Prikryl et al. 2000). The method selects q: by power
/// (Eq. 3), by direct importance, or by total or indirect importance (Eq. 9, 10). A share beta is sampled by power
/// alone. Another share is sampled by neighbourhood importance, because underestimated small lamps give rays large
/// weights. Sets no oracle.
/// @param weights   importance_weights(so_far).
/// @param emission  Luminaires, shot if `light` emits.
/// @param light     Radiosity to shoot. The step refers to data of `so_far`, `emission` and `light`.
PowerStep power_step(const Materials& materials, const Emission& emission, const Solution& so_far,
                     const Radiosity& light, const ImportanceWeights& weights, bool combined, std::int64_t rays);

/// Makes a step with importance alone (Eq. 8). @param importance  Importance to reflect; the step refers to it.
TransportStep importance_step(const Materials& materials, const Solution& so_far, const Importance& importance,
                              std::int64_t rays);

/// Makes the oracle of the method (Eq. 14 or 15), relative to the references below.
/// @param rays  Number of rays averaged after this step, > 0. The threshold falls as it grows.
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// Returns the reference of the oracle's threshold [lm or W]: the power that visible patches receive at the mean
/// irradiance of the picture. It is independent of lamps in the picture, light elsewhere, tessellation and unit of
/// length. Without a view, or while the visible patches are dark: all emitted power.
double reference_power(const Solution& so_far);

/// Returns psi_max of Eq. 15 [1/m^2]: the area-weighted mean over the visible patches.
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::inline detail
