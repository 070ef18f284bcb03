#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/surfaces.h"

namespace interflect {

/// The leaves that rays may start on.
struct Sampled {
    const Surfaces& surfaces;
    const ElementForest& forest;
    std::span<const std::uint32_t> leaves;
};

// Weights of the leaves, not normalised; numbers of equations in Prikryl et al. 2000. The vectors have an entry for
// every element of the forest: B [lm/m^2 or W/m^2], psi [1/m^2].

/// Eq. 3: P_s, all channels together.
std::vector<double> power_weights(const Sampled& s, const std::vector<Rgb>& radiosity);
/// Eq. 8: rho_s I_s.
std::vector<double> reflected_importance_weights(const Sampled& s, const std::vector<float>& importance);
/// Eq. 9 and 10: P_s psi_s, psi being what drives: total or indirect importance.
std::vector<double> driven_weights(const Sampled& s, const std::vector<Rgb>& radiosity,
                                   const std::vector<float>& importance);

/// Importance as it should drive rays. That of a leaf comes from few rays, and where it is underestimated the few rays
/// that start there carry much: so an element has the share `from_parent` of what its parent has here. And what a
/// source deserves is the root of the mean square of what its rays meet, not the mean: of two sources of the same mean
/// that is greater for the one with few rays that matter (light that comes through a doorway); hence an exponent
/// below 1. (0, 1) leaves importance as it is, as in the paper.
std::vector<float> driving_importance(const ElementForest& forest, std::vector<float> importance, double from_parent,
                                      double exponent);

/// Adds `share` of the distribution that `weights` make to q; nothing where they are all 0.
void mix_in(std::vector<double>& q, const std::vector<double>& weights, double share);

}  // namespace interflect
