#include "interflect/luminaires/illumination.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/luminaires/opening.h"

namespace interflect::detail {

namespace {

Illumination from_point(const V3f& position, const Rgb& intensity, const V3f& x) {
    const V3f d = position - x;
    const float distance = d.length();
    if (!(distance > 0)) return {};
    return {d / distance, distance, intensity / distance / distance};
}

Illumination light_at(const PointLight& light, const V3f& x, float, float) {
    return from_point(light.position, light.intensity, x);
}

Illumination light_at(const SpotLight& light, const V3f& x, float, float) {
    Illumination i = from_point(light.position, light.intensity, x);
    const float cosine = -i.towards.dot(light.direction.normalized());
    const float inner = light.inner_cosine(), outer = light.outer_cosine();
    if (cosine >= inner) return i;
    const float falloff = cosine > outer ? (cosine - outer) / (inner - outer) : 0;
    i.irradiance *= falloff * falloff;
    return i;
}

/// Samples the disc's solid angle, 2 pi (1 - cos r), uniformly. Its radiance is E / (pi sin^2 r).
Illumination light_at(const DirectionalLight& light, const V3f&, float u, float v) {
    const V3f axis = -light.direction.normalized();
    constexpr float everywhere = std::numeric_limits<float>::infinity();
    if (light.diameter == 0) return {axis, everywhere, light.irradiance};
    const TangentFrame frame(axis);
    const float edge = light.disc_sine(), edge_cosine = std::sqrt(1 - edge * edge);
    const float height = v * (edge * edge / (1 + edge_cosine));  // 1 - cosine
    const float sine = std::sqrt(height * (2 - height)), turn = 2 * std::numbers::pi_v<float> * u;
    const V3f towards = axis * (1 - height) + frame.s * (sine * std::cos(turn)) + frame.t * (sine * std::sin(turn));
    return {towards, everywhere, light.irradiance * (2 / (1 + edge_cosine))};
}

Illumination light_at(const UniformSky&, const V3f&, float, float) { return {}; }
Illumination light_at(const SkyDome&, const V3f&, float, float) { return {}; }
Illumination light_at(const EnvironmentMap&, const V3f&, float, float) { return {}; }

/// Samples a point of the opening as seen from its centre, with density |n d0| / A(d0); A is the projected area. With
/// radiance I(d) / A(d), the irradiance is I(d) / r^2 (n d / A(d)) / (n d0 / A(d0)).
Illumination light_at(const MeasuredLight& light, const V3f& x, float u, float v) {
    constexpr float surface_tolerance = 0x1p-14f;  // relative to distance: the opening may lie in a surface
    const LuminaireFrame frame(light);
    const LuminousOpening& opening = light.web->opening;
    const V3f from_middle = frame.to_luminaire(x - light.position);
    if (!(from_middle.length() > 0)) return {};
    const V3f d0 = from_middle.normalized();
    const OpeningPoint y = sample_opening(opening, d0, u, v);
    Illumination i = from_point(light.position + frame.to_scene(y.position), light.factor, x);
    const V3f d = frame.to_luminaire(-i.towards);
    i.irradiance *= light.web->intensity(d);
    i.distance *= 1 - surface_tolerance;
    if (y.normal == V3f(0)) return i;
    const float seen = std::max(0.0f, y.normal.dot(d)) * projected_area(opening, d0),
                chosen = y.normal.dot(d0) * projected_area(opening, d);
    i.irradiance *= chosen > 0 ? seen / chosen : 0;
    return i;
}

}  // namespace

Illumination illumination(const Luminaire& luminaire, const V3f& x, float u, float v) {
    return std::visit([&](const auto& light) { return light_at(light, x, u, v); }, luminaire.kind);
}

}  // namespace interflect::detail
