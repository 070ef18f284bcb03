#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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

/// Computes the weights of elements again, as importance_weights() has done with this importance of the first
/// elements. Newer elements have the weights of their parents.
std::vector<float> element_weights(const Solution& so_far, std::span<const float> indirect_importance);
/// Returns whether importance_weights() depends on the indirect importance alone, besides luminaires.
bool weighs_by_indirect_importance(const Solution& so_far);

/// Smooths importance for sampling (docs/method/method.md, One step of transport). The paper uses `from_parent` 0 and
/// `exponent` 1.
/// @param elements  Number of elements, which includes the parent of each.
std::vector<float> smoothed_importance(const ElementForest& forest, const Importance& importance, double from_parent,
                                       double exponent, std::size_t elements);
inline std::vector<float> smoothed_importance(const ElementForest& forest, const Importance& importance,
                                              double from_parent, double exponent) {
    return smoothed_importance(forest, importance, from_parent, exponent, forest.size());
}

}  // namespace interflect::detail
