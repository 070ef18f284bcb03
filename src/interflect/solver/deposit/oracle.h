#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "interflect/core.h"

namespace interflect::detail {

/// Element or luminaire part at one end of a pair.
struct ElementProxy {
    V3f centre{0, 0, 0};  ///< [m]
    V3f normal{0, 0, 0};
    float area = 0;  ///< [m^2]
    /// Lower bound of the cosine at this end; 1 for an isotropic source.
    float min_cosine = 0;
};

/// Estimates an upper bound of the form factor from receiver to shooter: f cos_i cos_j, where f = A_j / (pi d^2 + A_j)
/// is the form factor of a disk of area A_j at the distance d. The cosines are at least 2 f, because some parts of
/// close elements face each other more directly than their centres do.
inline float form_factor_estimate(const ElementProxy& shooter, const ElementProxy& receiver) {
    // No branches, so that compilers generate vector code.
    const auto smaller = [](float x, float y) { return x < y ? x : y; };
    const auto larger = [](float x, float y) { return x < y ? y : x; };
    const V3f d = receiver.centre - shooter.centre;
    const float d2 = d.dot(d);
    const float f = shooter.area / (std::numbers::pi_v<float> * d2 + shooter.area);
    const float per_distance = 1 / std::sqrt(larger(d2, std::numeric_limits<float>::min()));
    const float least = smaller(1, 2 * f);
    const float from_shooter =
        smaller(1, larger(larger(least, shooter.min_cosine), shooter.normal.dot(d) * per_distance));
    const float to_receiver = smaller(1, larger(least, -receiver.normal.dot(d) * per_distance));
    return f * from_shooter * to_receiver;
}

/// Refinement test, based on the state before the step.
struct Oracle {
    bool refines = false;
    double threshold = 0;  ///< Power P_eps, times psi_max if by_importance [lm or W].
    bool by_importance = false;
    float min_area = 0;  ///< Minimum area of children [m^2].
    /// Maximum number of elements at the end of a step; collect() removes the excess.
    std::size_t max_elements = std::numeric_limits<std::size_t>::max();

    /// Importance psi of every element before the step; empty unless by_importance.
    std::vector<float> importance;

    /// Evaluates Eq. 14, or Eq. 15 if by_importance: rho_i B_j A_i psi_i f <= threshold, with form_factor_estimate() f.
    /// @param reflected  Largest channel of rho_i B_j [lm/m^2 or W/m^2].
    /// @param psi        Importance psi_i of the receiver; 1 unless by_importance.
    bool accepts(const ElementProxy& shooter, const ElementProxy& receiver, float reflected, float psi) const {
        const double power = static_cast<double>(reflected) * receiver.area;
        return power * psi * form_factor_estimate(shooter, receiver) <= threshold;
    }
};

}  // namespace interflect::detail
