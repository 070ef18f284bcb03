#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/solve.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/neighbourhoods.h"
#include "interflect/solver/transport.h"

namespace interflect::inline detail {

/// Use of importance: as requested by the method, or off without a view.
ImportanceUse importance_use(const Solution& so_far);

/// Whether variance refines the mesh between passes.
bool refines_by_variance(const SolveOptions& options);

/// psi of every element; refers to the solution. Empty without a view.
Importance importance_of(const Solution& so_far);
/// Same, as a sum.
std::vector<float> total_importance(const Solution& so_far);

/// Importance for sampling rays with power, by method and options; empty if not used.
struct ImportanceWeights {
    std::vector<float> elements;
    std::vector<float> nearby;               ///< By patch, from its neighbourhoods; empty without smoothing.
    std::vector<float> parts, parts_nearby;  ///< Same, for luminaire parts; empty without luminaires.
};
/// @param found  Importance found by the rays of luminaire parts so far.
ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission = {}, const std::vector<PartImportance>& found = {});

/// Step with its sampling sums over the leaves: P_s (Eq. 3), and P_s times the sampling importance (Eq. 9, 10; 0 if not
/// used).
struct PowerStep {
    TransportStep step;
    double power = 0, weighted_power = 0;
    std::int64_t lost_leaves = 0;  ///< Leaves with non-finite radiosity; they shoot no rays.
};

/// Makes a step that carries power and, if `combined`, importance too (Eq. 11, Prikryl et al. 2000). The method selects
/// the weights of leaves: power (Eq. 3), direct importance, or total or indirect importance (Eq. 9, 10). A share beta
/// of the rays is sampled by power alone, and another by neighbourhood importance. Few rays with importance hit a small
/// lamp. If its importance is underestimated, the few rays that start there have large weights. Sets no oracle.
/// @param weights  importance_weights(so_far).
/// @param emission  Luminaires; they shoot if `light` emits.
/// @param light    Radiosity to shoot. The step refers to the data of `so_far`, `emission` and `light`.
PowerStep power_step(const Materials& materials, const Emission& emission, const Solution& so_far,
                     const Radiosity& light, const ImportanceWeights& weights, bool combined, std::int64_t rays);

/// Makes a step that carries importance only (Eq. 8). @param importance  To reflect; the step refers to it.
TransportStep importance_step(const Materials& materials, const Solution& so_far, const Importance& importance,
                              std::int64_t rays);

/// Makes the oracle of the method (Eq. 14 or 15), relative to the references below.
/// @param rays  Number of averaged rays after this step, > 0. The threshold falls as it grows.
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// Reference of the oracle's threshold [lm or W]. With a view: the power that visible patches would receive if all had
/// the mean irradiance of the picture. It does not depend on lamps in the picture, lights elsewhere or the tessellation
/// of emitters. Both sides of Eq. 14 scale with the square of length, so the unit of length does not matter. Without a
/// view, or while the visible patches are dark: all emitted power.
double reference_power(const Solution& so_far);

/// psi_max of Eq. 15: the area-weighted mean of psi over the visible patches [1/m^2].
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::inline detail
