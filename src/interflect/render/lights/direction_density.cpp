#include "interflect/render/lights/direction_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "interflect/geometry/tangent_frame.h"

namespace interflect::detail {

namespace {

/// Changes little between similar normals. Its singularity is far from the normals of walls and floors.
struct SteadyFrame {
    V3f s, t, n;

    explicit SteadyFrame(const V3f& normal) : n(normal) {
        const V3f oblique(0.36f, 0.48f, 0.8f);
        s = oblique.cross(n);
        s = s.length() > 1e-4f ? s.normalized() : TangentFrame(n).s;
        t = n.cross(s);
    }
    /// Maps [0, 1)^2 to directions of density cosine / pi.
    V3f direction(float a, float b) const {
        const float radius = std::sqrt(a), turn = 2 * std::numbers::pi_v<float> * b;
        return s * (radius * std::cos(turn)) + t * (radius * std::sin(turn)) + n * std::sqrt(1 - a);
    }
};

}  // namespace

DirectionDensity::DirectionDensity(const Cells& light) {
    constexpr float share_of_neighbours = 0.1f;
    Cells weights;
    for (std::size_t c = 0; c < cells; ++c) {
        const std::size_t ring = c / side, sector = c % side;
        float around = 0;
        for (std::size_t i = std::max<std::size_t>(ring, 1) - 1; i <= std::min(ring + 1, side - 1); ++i)
            for (const std::size_t turn : {side - 1, std::size_t{0}, std::size_t{1}})
                around += light[i * side + (sector + turn) % side];
        weights[c] = light[c] + share_of_neighbours * around;
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) return;
    double below = 0;
    for (std::size_t c = 0; c < cells; ++c) {
        below += static_cast<double>(weights[c]);
        cumulative_[c] =
            static_cast<std::uint16_t>(std::min<double>(max_cumulative, std::round(max_cumulative * below / sum)));
    }
    cumulative_.back() = max_cumulative;
}

float DirectionDensity::probability(std::size_t cell) const {
    const int below = cell > 0 ? cumulative_[cell - 1] : 0;
    return static_cast<float>(cumulative_[cell] - below) / max_cumulative;
}

std::size_t DirectionDensity::cell_at(double x) const {
    const auto below = static_cast<std::uint16_t>(x * max_cumulative);
    return static_cast<std::size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), below) -
                                    cumulative_.begin());
}

float DirectionDensity::density(const V3f& n, const V3f& direction) const {
    const float cosine = n.dot(direction);
    if (!(cosine > 0)) return 0;
    return probability(cell_of(n, direction)) * (static_cast<float>(cells) * cosine / std::numbers::pi_v<float>);
}

std::size_t DirectionDensity::cell_of(const V3f& n, const V3f& direction) {
    const SteadyFrame frame(n);
    const float cosine = n.dot(direction);
    const float turn = std::atan2(direction.dot(frame.t), direction.dot(frame.s)) / (2 * std::numbers::pi_v<float>);
    const auto index = [](float x) { return std::min(static_cast<std::size_t>(x * side), side - 1); };
    return index(std::max(0.0f, 1 - cosine * cosine)) * side + index(turn < 0 ? std::max(0.0f, turn + 1) : turn);
}

V3f DirectionDensity::direction_in(std::size_t cell, const V3f& n, float u, float v) {
    const std::size_t ring = cell / side, sector = cell % side;
    return SteadyFrame(n).direction((static_cast<float>(ring) + u) / side, (static_cast<float>(sector) + v) / side);
}

}  // namespace interflect::detail
