#include "interflect/luminaires/illumination.h"

#include <limits>

#include "interflect/luminaires/opening.h"

namespace interflect::inline detail {

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
    const float fall = cosine > outer ? (cosine - outer) / (inner - outer) : 0;
    i.irradiance *= fall * fall;
    return i;
}

Illumination light_at(const DirectionalLight& light, const V3f&, float, float) {
    return {-light.direction.normalized(), std::numeric_limits<float>::infinity(), light.irradiance};
}

Illumination light_at(const UniformSky&, const V3f&, float, float) { return {}; }

/// A point y of the opening, chosen as if all of it were seen from its middle: with a density |n d0| / A(d0) over the
/// surface, where A is its projected area. Its radiance is I(d) / A(d), so that what it causes is I(d) / r^2 times
/// (n d / A(d)) / (n d0 / A(d0)).
Illumination light_at(const MeasuredLight& light, const V3f& x, float u, float v) {
    constexpr float surface_tolerance = 0x1p-14f;  // of the distance: the opening may lie in a surface
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

Rgb sky_radiance(const Scene& scene) {
    Rgb sum(0, 0, 0);
    for (const Luminaire& luminaire : scene.luminaires)
        if (const UniformSky* sky = std::get_if<UniformSky>(&luminaire.kind)) sum += sky->radiance;
    return sum;
}

}  // namespace interflect::inline detail
