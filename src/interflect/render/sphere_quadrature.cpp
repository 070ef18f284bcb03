#include "interflect/render/sphere_quadrature.h"

#include <cmath>
#include <numbers>

namespace interflect::detail {

namespace {

struct Legendre {
    double value, derivative;
};

Legendre legendre(int degree, double x) {
    double before = 1, value = x;
    for (int k = 2; k <= degree; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
    }
    return {value, degree * (x * value - before) / (x * x - 1)};
}

}  // namespace

std::vector<SphereNode> sphere_quadrature(int rows) {
    std::vector<SphereNode> nodes;
    for (int i = 0; i < rows; ++i) {
        // Find a root of the Legendre polynomial by Newton's method, which converges from this estimate in a few steps
        double x = std::cos(std::numbers::pi * (i + 0.75) / (rows + 0.5));
        constexpr int newton_steps = 8;
        for (int k = 0; k < newton_steps; ++k) {
            const Legendre p = legendre(rows, x);
            x -= p.value / p.derivative;
        }
        const double slope = legendre(rows, x).derivative, sine = std::sqrt(1 - x * x);
        const double weight = 2 / ((1 - x * x) * slope * slope) * std::numbers::pi / rows;
        for (int j = 0; j < 2 * rows; ++j) {
            const double azimuth = std::numbers::pi * j / rows;
            nodes.push_back({V3f(static_cast<float>(sine * std::cos(azimuth)),
                                 static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(x)),
                             static_cast<float>(weight)});
        }
    }
    return nodes;
}

}  // namespace interflect::detail
