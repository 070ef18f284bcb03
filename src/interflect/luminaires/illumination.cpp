#include "interflect/luminaires/illumination.h"

#include <limits>

namespace interflect::inline detail {

namespace {

Illumination from_point(const V3f& position, const Rgb& intensity, const V3f& x) {
    const V3f d = position - x;
    const float distance = d.length();
    if (!(distance > 0)) return {};
    return {d / distance, distance, intensity / distance / distance};
}

Illumination light_at(const PointLight& light, const V3f& x) { return from_point(light.position, light.intensity, x); }

Illumination light_at(const SpotLight& light, const V3f& x) {
    Illumination i = from_point(light.position, light.intensity, x);
    const float cosine = -i.towards.dot(light.direction.normalized());
    const float inner = light.inner_cosine(), outer = light.outer_cosine();
    if (cosine >= inner) return i;
    const float fall = cosine > outer ? (cosine - outer) / (inner - outer) : 0;
    i.irradiance *= fall * fall;
    return i;
}

Illumination light_at(const DirectionalLight& light, const V3f&) {
    return {-light.direction.normalized(), std::numeric_limits<float>::infinity(), light.irradiance};
}

Illumination light_at(const UniformSky&, const V3f&) { return {}; }

}  // namespace

Illumination illumination(const Luminaire& luminaire, const V3f& x) {
    return std::visit([&](const auto& light) { return light_at(light, x); }, luminaire.kind);
}

Rgb sky_radiance(const Scene& scene) {
    Rgb sum(0, 0, 0);
    for (const Luminaire& luminaire : scene.luminaires)
        if (const UniformSky* sky = std::get_if<UniformSky>(&luminaire.kind)) sum += sky->radiance;
    return sum;
}

}  // namespace interflect::inline detail
