#include "interflect/scene/sky/sky_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace interflect::detail {

namespace {

constexpr float radians_of_turn = 2 * std::numbers::pi_v<float>;

V3f horizontal_part(const V3f& v, const V3f& zenith) { return (v - zenith * zenith.dot(v)).normalized(); }

V3f default_north(const V3f& zenith) {
    constexpr float close = 0.9f;
    return std::abs(zenith.normalized().y) < close ? V3f(0, 1, 0) : V3f(0, 0, -1);
}

}  // namespace

SkyFrame::SkyFrame(const V3f& up) : SkyFrame(up, default_north(up)) {}

SkyFrame::SkyFrame(const V3f& up, const V3f& towards_north) : zenith(up.normalized()) {
    north = horizontal_part(towards_north, zenith);
    east = north.cross(zenith);
}

V3f SkyFrame::direction(const SkyPlace& place) const {
    const float sine = std::sqrt(std::max(0.0f, 1 - place.cosine * place.cosine)),
                azimuth = radians_of_turn * (place.s - 0.5f);
    return east * (sine * std::sin(azimuth)) + north * (sine * std::cos(azimuth)) + zenith * place.cosine;
}

SkyPlace SkyFrame::place(const V3f& direction) const {
    const float azimuth = std::atan2(direction.dot(east), direction.dot(north));
    return {0.5f + azimuth / radians_of_turn, direction.dot(zenith)};
}

}  // namespace interflect::detail
