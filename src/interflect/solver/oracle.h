#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "interflect/colour.h"

namespace interflect {

/// One end of an interaction, as the oracle sees it.
struct ElementProxy {
    V3f centre{0, 0, 0};  ///< [m]
    V3f normal{0, 0, 0};  ///< Unit length.
    float area = 0;       ///< [m^2]
    /// No cosine to the normal is taken below that: 1 for what shines alike in all directions.
    float least_cosine = 0;
};

/// Cheap upper estimate of the form factor from receiver to shooter: the solid angle of a disk of the shooter's area,
/// f = A_j / (pi d^2 + A_j), times the cosines at both ends of the line between the centres. No cosine is taken below 2
/// f: where the elements are close for their size, some of their parts face each other better than their centres do.
inline float form_factor_estimate(const ElementProxy& shooter, const ElementProxy& receiver) {
    // By value and without branches, so that many pairs can be judged at once.
    const auto smaller = [](float x, float y) { return x < y ? x : y; };
    const auto larger = [](float x, float y) { return x < y ? y : x; };
    const V3f d = receiver.centre - shooter.centre;
    const float d2 = d.dot(d);
    const float f = shooter.area / (std::numbers::pi_v<float> * d2 + shooter.area);
    const float per_distance = 1 / std::sqrt(larger(d2, std::numeric_limits<float>::min()));
    const float least = smaller(1, 2 * f);
    const float from_shooter =
        smaller(1, larger(larger(least, shooter.least_cosine), shooter.normal.dot(d) * per_distance));
    const float to_receiver = smaller(1, larger(least, -receiver.normal.dot(d) * per_distance));
    return f * from_shooter * to_receiver;
}

/// Decides for every ray whether two elements may exchange light as they are. Its verdict depends on the state at the
/// beginning of an iteration alone, never on what other rays do.
struct Oracle {
    bool refines = false;  ///< False: the leaves that the ray connects exchange light.
    double threshold = 0;  ///< P_eps, times psi_max where importance decides too [lm or W].
    bool by_importance = false;
    float min_area = 0;  ///< An element of less than four times this is not subdivided [m^2].
    /// The forest grows to no more than this. What a step makes beyond it is dropped at the step's end, the last first
    /// in the forest's order: so which elements there are does not depend on which thread was first.
    std::size_t max_elements = std::numeric_limits<std::size_t>::max();

    /// psi of every element as the step finds it, by which receivers are weighed; empty unless by_importance.
    std::vector<float> importance;

    /// Eq. 14 (by_importance == false) and Eq. 15, Prikryl et al. 2000; of the channels the largest decides.
    /// @param reflected  The largest channel of rho_i B_j, the receiver's reflectance times the shooter's radiosity
    ///                   [lm/m^2 or W/m^2].
    /// @param psi        psi_i of the receiver; 1 unless by_importance.
    bool accepts(const ElementProxy& shooter, const ElementProxy& receiver, float reflected, float psi) const {
        const double power = static_cast<double>(reflected) * receiver.area;
        return power * psi * form_factor_estimate(shooter, receiver) <= threshold;
    }
};

}  // namespace interflect
