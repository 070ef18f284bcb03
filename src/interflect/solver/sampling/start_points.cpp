#include "interflect/solver/sampling/start_points.h"

#include <algorithm>
#include <tuple>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

/// Returns x in [0, 1], quantised to 16 bits, which occupy the even bits of the result.
std::uint32_t spread_bits(float x) {
    auto bits = static_cast<std::uint32_t>(std::clamp(x, 0.0f, 1.0f) * 65535.0f);
    bits = (bits | bits << 8) & 0x00ff00ffu;
    bits = (bits | bits << 4) & 0x0f0f0f0fu;
    bits = (bits | bits << 2) & 0x33333333u;
    return (bits | bits << 1) & 0x55555555u;
}

bool is_before(const StartPoint& a, const StartPoint& b) {
    return std::tie(a.leaf, a.place_on_curve, a.at.u, a.at.v, a.power) <
           std::tie(b.leaf, b.place_on_curve, b.at.u, b.at.v, b.power);
}

}  // namespace

StartPoint::StartPoint(std::uint32_t of_leaf, float of_power, const Parameters& point)
    : leaf(of_leaf), power(of_power), at(point), place_on_curve(spread_bits(point.u) | spread_bits(point.v) << 1) {}

StartPoints::StartPoints(std::vector<StartPoint> points) : points_(std::move(points)) {
    parallel_sort(points_, is_before);
    double sum = 0;  // a float would lose small terms
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (i == 0 || points_[i].leaf != points_[i - 1].leaf) sum = 0;
        sum += static_cast<double>(points_[i].power);
        points_[i].power = static_cast<float>(sum);
    }
}

std::span<const StartPoint> StartPoints::of(ElementIndex leaf) const {
    const auto is_below = [](const StartPoint& p, std::uint32_t l) { return p.leaf < l; };
    const auto begin = std::lower_bound(points_.begin(), points_.end(), leaf, is_below);
    const auto end = std::lower_bound(begin, points_.end(), leaf + 1, is_below);
    return {begin, end};
}

Parameters StartPoints::choose(std::span<const StartPoint> points, float u) {
    const float wanted = u * points.back().power;
    const auto found = std::upper_bound(points.begin(), points.end(), wanted,
                                        [](float x, const StartPoint& p) { return x < p.power; });
    return found == points.end() ? points.back().at : found->at;
}

}  // namespace interflect::detail
