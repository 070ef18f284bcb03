#pragma once

#include <cstdint>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solution.h"
#include "interflect/solver/importance/neighbourhoods.h"
#include "interflect/solver/light/radiosity.h"

namespace interflect::detail {

/// Returns the use of importance by the method; off without a view.
ImportanceUse importance_use(const Solution& so_far);

/// Returns psi of every element, empty without a view. Refers to the solution.
Importance importance_of(const Solution& so_far);
std::vector<float> total_importance(const Solution& so_far);

/// Importance found by the rays of a luminaire part.
struct PartImportance {
    double found = 0;  ///< Sum over its rays [1/m^2]
    double rays = 0;
};

/// Importance for sampling rays of power; empty if not used.
struct ImportanceWeights {
    std::vector<float> elements;
    std::vector<float> nearby;               ///< Neighbourhood importance by patch; empty without smoothing.
    std::vector<float> parts, parts_nearby;  ///< The same for luminaire parts.
};
/// @param found  Importance found by rays of luminaire parts so far.
ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission = {}, const std::vector<PartImportance>& found = {});

/// Smooths importance for sampling. If the few rays of a leaf underestimate it, rays that start there have large
/// weights. So a share `from_parent` of the parent's result is mixed in. The optimal ray density is proportional to the
/// root mean square of the importance met. This exceeds the mean for light through a doorway, hence an exponent below
/// 1. The paper uses (0, 1).
std::vector<float> importance_weight(const ElementForest& forest, const Importance& importance, double from_parent,
                                     double exponent);

}  // namespace interflect::detail
