#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/surfaces.h"

namespace interflect {

/// What the sampling probabilities of leaves are made of; every vector has an entry for every element of the forest.
struct Sampled {
    const Surfaces& surfaces;
    const ElementForest& forest;
    std::span<const std::uint32_t> leaves;
    const std::vector<Rgb>& radiosity;              ///< B [lm/m^2 or W/m^2].
    const std::vector<float>& view_importance;      ///< v; may be empty: no view.
    const std::vector<float>& indirect_importance;  ///< psi - v; may be empty: none.
};

// Weights of the leaves, not normalised; numbers of equations in Prikryl et al. 2000.
std::vector<double> power_weights(const Sampled& s);                ///< Eq. 3: P_s, all channels together.
std::vector<double> importance_weights(const Sampled& s);           ///< Eq. 8: rho_s I_s.
std::vector<double> total_importance_weights(const Sampled& s);     ///< Eq. 9: P_s I_s / A_s.
std::vector<double> indirect_importance_weights(const Sampled& s);  ///< Eq. 10: P_s (I_s - V_s) / A_s.
std::vector<double> view_weights(const Sampled& s);  ///< P_s V_s / A_s: what is seen, not what lights it.

/// Adds `share` of the distribution that `weights` make to q; nothing where they are all 0.
void mix_in(std::vector<double>& q, const std::vector<double>& weights, double share);

}  // namespace interflect
