#include "interflect/light_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "interflect/scene/core/limits.h"

namespace interflect {

using namespace detail;

namespace {

constexpr float straight_angle = 180;  // [degrees]
constexpr float degree = std::numbers::pi_v<float> / straight_angle;

std::string position_fault(const V3f& x) {
    const Imath::V3d position(x);
    if (!is_finite(position)) return "has a position that is not finite";
    return is_within_reach(position) ? std::string()
                                     : fmt::format("is farther than {:g} m from the origin", farthest_coordinate);
}

std::string direction_fault(const V3f& d) {
    return is_finite(Imath::V3d(d)) && d.length() > 0 ? std::string()
                                                      : std::string("needs a direction that is finite and not zero");
}

std::string placement_fault(const PointLight& light) { return position_fault(light.position); }
std::string placement_fault(const DirectionalLight& light) {
    constexpr float widest_disc = 90;
    if (!(light.diameter >= 0 && light.diameter <= widest_disc))
        return fmt::format("has a disc of {} degrees; expected 0 to {}", light.diameter, widest_disc);
    return direction_fault(light.direction);
}
std::string placement_fault(const UniformSky&) { return {}; }
std::string placement_fault(const SkyDome& sky) {
    constexpr float rounding = -1e-4f;  // of the cosine
    for (const std::string& fault : {direction_fault(sky.zenith), direction_fault(sky.sun), sky_fault(sky.model)})
        if (!fault.empty()) return fault;
    if (sky.sun.normalized().dot(sky.zenith.normalized()) < rounding) return "has its sun below the horizon";
    constexpr float brightest_ground = 1e6f;
    if (!(sky.ground >= 0 && sky.ground <= brightest_ground))
        return fmt::format("has a ground of {} times its light; expected 0 to {:g}", sky.ground, brightest_ground);
    return {};
}
std::string placement_fault(const EnvironmentMap& map) {
    for (const std::string& fault : {direction_fault(map.zenith), direction_fault(map.north)})
        if (!fault.empty()) return fault;
    constexpr float min_sine = 1e-4f;  // of the angle between zenith and north
    const bool is_frame = map.zenith.normalized().cross(map.north.normalized()).length() > min_sine;
    return is_frame ? std::string() : std::string("has its north at the zenith");
}
std::string placement_fault(const SpotLight& light) {
    const bool is_cone = light.inner_angle >= 0 && light.inner_angle <= light.outer_angle && light.outer_angle > 0 &&
                         light.outer_angle <= straight_angle;
    if (!is_cone)
        return fmt::format("has angles of {} and {} degrees; expected 0 <= inner <= outer, 0 < outer <= 180",
                           light.inner_angle, light.outer_angle);
    const std::string fault = position_fault(light.position);
    return fault.empty() ? direction_fault(light.direction) : fault;
}
std::string placement_fault(const MeasuredLight& light) {
    constexpr float min_sine = 1e-4f;  // of the angle between nadir and C0 direction
    for (const std::string& fault :
         {position_fault(light.position), direction_fault(light.direction), direction_fault(light.c0)})
        if (!fault.empty()) return fault;
    const bool is_frame = light.direction.normalized().cross(light.c0.normalized()).length() > min_sine;
    return is_frame ? std::string() : std::string("has a C0 plane along its own axis");
}

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace

float SpotLight::inner_cosine() const { return std::cos(inner_angle * degree); }
float SpotLight::outer_cosine() const { return std::cos(outer_angle * degree); }
float DirectionalLight::disc_sine() const { return std::sin(diameter / 2 * degree); }
Rgb DirectionalLight::disc_radiance() const {
    return irradiance / (std::numbers::pi_v<float> * disc_sine() * disc_sine());
}

Rgb rating(const Luminaire& luminaire) {
    return std::visit(Overloaded{[](const PointLight& light) { return light.intensity; },
                                 [](const SpotLight& light) { return light.intensity; },
                                 [](const DirectionalLight& light) { return light.irradiance; },
                                 [](const UniformSky& sky) { return sky.radiance; },
                                 [](const MeasuredLight& light) { return light.factor * light.web->peak(); },
                                 [](const SkyDome& sky) { return sky.irradiance; },
                                 [](const EnvironmentMap& map) { return map.factor * largest_texel(*map.image); }},
                      luminaire.kind);
}

bool is_sky(const Luminaire& luminaire) {
    return std::holds_alternative<UniformSky>(luminaire.kind) || std::holds_alternative<SkyDome>(luminaire.kind) ||
           std::holds_alternative<EnvironmentMap>(luminaire.kind);
}

const char* kind_name(const Luminaire& luminaire) {
    constexpr std::array<const char*, 7> names{"point",    "spot",     "directional", "sky",
                                               "measured", "sky-dome", "environment"};
    return names[luminaire.kind.index()];
}

std::string luminaire_fault(const Luminaire& luminaire) {
    if (const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind)) {
        if (!measured->web) return "has no photometric web";
        if (std::string fault = web_fault(*measured->web); !fault.empty()) return fault;
    }
    if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind)) {
        if (!map->image) return "has no image";
        if (std::string fault = texture_fault(*map->image); !fault.empty()) return "has an image that " + fault;
    }
    const Rgb value = rating(luminaire);
    if (!is_finite(value) || std::min({value.x, value.y, value.z}) < 0)
        return fmt::format("has a colour ({}, {}, {}) that is negative or not finite", value.x, value.y, value.z);
    if (largest_channel(value) > strongest_exitance)
        return fmt::format("is too bright: expected at most {:g} in its unit", strongest_exitance);
    return std::visit([](const auto& light) { return placement_fault(light); }, luminaire.kind);
}

}  // namespace interflect
