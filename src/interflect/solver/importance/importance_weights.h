#pragma once

#include <cstdint>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/luminaires/emission.h"
#include "interflect/solution.h"
#include "interflect/solver/importance/neighbourhoods.h"
#include "interflect/solver/light/radiosity.h"

namespace interflect::detail {

/// Returns the use of importance; ImportanceUse::off without a view.
ImportanceUse importance_use(const Solution& so_far);

/// Returns the importance psi of every element; empty without a view. Refers to the solution.
Importance importance_of(const Solution& so_far);
std::vector<float> total_importance(const Solution& so_far);

/// Importance that the rays of a luminaire part (Emission) have found.
struct PartImportance {
    double found = 0;  ///< Sum over the rays [1/m^2].
    double rays = 0;   ///< Number of rays.
};

/// Factors of the probability of sampling a source of power. Empty arrays have no effect.
struct ImportanceWeights {
    std::vector<float> elements;
    std::vector<float> nearby;               ///< Smoothed over the neighbourhood of each patch.
    std::vector<float> parts, parts_nearby;  ///< For each luminaire part, and smoothed over similar parts.
};
/// Computes the weights; empty without importance. @param found  Importance found by each luminaire part.
ImportanceWeights importance_weights(const Solution& so_far, const Neighbourhoods& neighbourhoods,
                                     const Emission& emission = {}, const std::vector<PartImportance>& found = {});

/// Smooths importance for sampling (docs/method/method.md, One step of transport). The paper uses `from_parent` 0 and
/// `exponent` 1.
std::vector<float> smoothed_importance(const ElementForest& forest, const Importance& importance, double from_parent,
                                       double exponent);

}  // namespace interflect::detail
