#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/light_sources.h"

namespace interflect::detail {

inline constexpr double full_turn = 360, half_turn = 180;  // [degrees]
inline constexpr float right_angle = 90;                   // [degrees]

inline double radians(double degrees) { return degrees * (std::numbers::pi / half_turn); }
inline double degrees(double radians) { return radians * (half_turn / std::numbers::pi); }

/// Unit vectors of the directions of a web, in the luminaire's frame.
struct WebAxes {
    V3f pole, zero, quarter;  ///< Azimuths 0 and 90 degrees are `zero` and `quarter`.
    explicit WebAxes(PhotometricWeb::Pole kind) : pole(0, 0, -1), zero(1, 0, 0), quarter(0, 1, 0) {
        if (kind == PhotometricWeb::Pole::c90) pole = {0, 1, 0}, zero = {0, 0, -1}, quarter = {1, 0, 0};
    }
};

/// Integrals over [a, b] [rad] of sin t times a linear function that is 1 at one end and 0 at the other.
struct BandWeights {
    double at_a, at_b;
    BandWeights(double a, double b) {
        const double slope = (std::sin(b) - std::sin(a)) / (b - a);
        at_a = std::max(0.0, std::cos(a) - slope);
        at_b = std::max(0.0, slope - std::cos(b));
    }
};

}  // namespace interflect::detail
