#include "interflect/render/lights/unoccluded_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "interflect/luminaires/illumination.h"

namespace interflect::detail {

namespace {

/// Beyond this number, the sum would take longer than the shadow rays.
constexpr std::size_t max_sources = 64;

/// Angle between unit vectors, times the component along n of their plane's unit normal.
float edge_integral(const V3f& a, const V3f& b, const V3f& n) {
    const V3f normal = a.cross(b);
    const float sine = normal.length();
    return sine > 0 ? std::atan2(sine, a.dot(b)) * (n.dot(normal) / sine) : 0;
}

}  // namespace

float polygon_irradiance(std::span<const V3f> vertices, const V3f& x, const V3f& n) {
    std::array<V3f, 5> above;  // clipping adds at most one corner
    std::size_t count = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const V3f a = vertices[i] - x, b = vertices[(i + 1) % vertices.size()] - x;
        const float height = n.dot(a), next = n.dot(b);
        if (height > 0) above[count++] = a;
        if ((height > 0) != (next > 0)) above[count++] = a + (b - a) * (height / (height - next));
    }
    for (std::size_t i = 0; i < count; ++i) above[i].normalize();
    float sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += edge_integral(above[i], above[(i + 1) % count], n);
    return std::abs(sum) / 2;
}

UnoccludedLight::UnoccludedLight(const Scene& scene, std::span<const PatchGeometry> geometry)
    : scene_(scene), geometry_(geometry) {
    bool is_uniform = true;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const Material& material = scene.materials[scene.patches[i].material];
        if (!(channel_sum(material.exitance) > 0)) continue;
        patches_.push_back(i);
        is_uniform = is_uniform && material.exitance_texture == none;
    }
    for (std::uint32_t i = 0; i < scene.luminaires.size(); ++i)
        if (!is_sky(scene.luminaires[i])) luminaires_.push_back(i);
    has_patches_ = is_uniform && patches_.size() <= max_sources;
    has_luminaires_ = luminaires_.size() <= max_sources;
}

Rgb UnoccludedLight::by_patches(const V3f& x, const V3f& n, std::uint32_t own) const {
    Rgb irradiance(0);
    for (const std::uint32_t i : patches_) {
        const Patch& patch = scene_.patches[i];
        std::array<V3f, 4> vertices;
        const auto count = static_cast<std::size_t>(patch.vertex_count());
        for (std::size_t k = 0; k < count; ++k) vertices[k] = scene_.vertices[patch.vertices[k]];
        if (i == own || geometry_[i].normal().dot(x - vertices[0]) <= 0) continue;
        irradiance += scene_.materials[patch.material].exitance *
                      (polygon_irradiance(std::span(vertices).first(count), x, n) / std::numbers::pi_v<float>);
    }
    return irradiance;
}

Rgb UnoccludedLight::by_luminaires(const V3f& x, const V3f& n) const {
    Rgb irradiance(0);
    for (const std::uint32_t i : luminaires_) {
        const Luminaire& luminaire = scene_.luminaires[i];
        const bool is_extended = std::holds_alternative<MeasuredLight>(luminaire.kind);
        const int across = is_extended ? 4 : 1;
        const float share = 1 / static_cast<float>(across * across);
        for (int k = 0; k < across * across; ++k) {
            const int column = k % across, row = k / across;
            const float u = (static_cast<float>(column) + 0.5f) / static_cast<float>(across),
                        v = (static_cast<float>(row) + 0.5f) / static_cast<float>(across);
            const Illumination light = illumination(luminaire, x, u, v);
            irradiance += light.irradiance * (std::max(0.0f, n.dot(light.towards)) * share);
        }
    }
    return irradiance;
}

}  // namespace interflect::detail
