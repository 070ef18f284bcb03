#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/solve.h"
#include "interflect/solver/materials.h"
#include "interflect/solver/neighbourhoods.h"
#include "interflect/solver/transport.h"

namespace interflect::inline detail {

/// What steers a run: what its method asks for, and nothing where there is no view.
ImportanceUse importance_use(const Solution& so_far);

/// Whether the mesh of a run is refined between its passes, by what they tell of its elements.
bool refines_by_variance(const SolveOptions& options);

/// psi of every element, which refers to the solution; empty where there is no view.
Importance importance_of(const Solution& so_far);
/// The same, added up.
std::vector<float> total_importance(const Solution& so_far);

/// The importance that drives the rays of power, as the method and the options ask for; empty where none does.
struct ImportanceWeights {
    std::vector<float> elements;
    std::vector<float> nearby;  ///< Of patches, as it is in their neighbourhoods; empty where it is taken as it is.
    std::vector<float> parts, parts_nearby;  ///< The same of the luminaires' parts; empty without luminaires.
};
/// @param found  By the rays of the luminaires' parts so far.
ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission = {}, const std::vector<PartImportance>& found = {});

/// A step, and what there is to shoot in it: sums over the leaves of P_s (Eq. 3), and of that times the importance that
/// drives rays (Eq. 9, 10; 0 where none does).
struct PowerStep {
    TransportStep step;
    double power = 0, weighted_power = 0;
    std::int64_t lost_leaves = 0;  ///< Those of which nothing can be shot, since it is not finite.
};

/// A step in which rays carry power; where `combined`, importance too (Eq. 11). Leaves are chosen as the method of the
/// run says: by power (Eq. 3), by what is seen, or by total or indirect importance (Eq. 9, 10); a share beta by power
/// alone, and one by the importance nearby: few rays that bring importance meet a small lamp, and where it has been
/// taken for unimportant the few rays that start there carry much. No oracle is set.
/// @param weights  importance_weights(so_far).
/// @param emission  Of the luminaires: it is shot where `light` emits.
/// @param light    What is to be shot. The step refers to what `so_far`, `emission` and `light` do.
PowerStep power_step(const Materials& materials, const Emission& emission, const Solution& so_far,
                     const Radiosity& light, const ImportanceWeights& weights, bool combined, std::int64_t rays);

/// A step in which rays carry importance alone (Eq. 8). @param importance  What is to be reflected; the step refers to
/// it.
TransportStep importance_step(const Materials& materials, const Solution& so_far, const Importance& importance,
                              std::int64_t rays);

/// The oracle of the run's method, Eq. 14 or 15, with the references below.
/// @param rays  That irradiance is the mean of, after this step; > 0. The more, the lower the threshold.
Oracle make_oracle(const Solution& so_far, std::int64_t rays, double min_area);

/// The power that the oracle's threshold is relative to [lm or W]. With a view: what arrives at the surfaces it sees,
/// as if all were lit as they are on average; so it depends neither on lamps in the picture nor on lights elsewhere,
/// nor on how an emitter is divided, nor (times a length squared on both sides of Eq. 14) on the unit of length.
/// Without a view, and as long as what it sees is dark: all emitted power.
double reference_power(const Solution& so_far);

/// psi_max of Eq. 15: the area-weighted mean of psi over the patches that the view sees [1/m^2].
double reference_importance(const Solution& so_far, const std::vector<float>& psi);

}  // namespace interflect::inline detail
