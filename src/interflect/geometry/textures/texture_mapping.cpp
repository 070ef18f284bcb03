#include "interflect/geometry/textures/texture_mapping.h"

#include <array>
#include <span>

namespace interflect::detail {

namespace {

Rgb times_texel(const Scene& scene, const Patch& patch, Parameters p, const Rgb& factor, std::uint32_t texture) {
    if (texture == none) return factor;
    return factor * texel_at(scene.textures[texture], texture_coordinate(scene, patch, p));
}

}  // namespace

V2f texture_coordinate(const Scene& scene, const Patch& patch, Parameters p) {
    const auto at = [&](std::size_t k) { return scene.texture_coordinates[patch.vertices[k]]; };
    if (patch.is_triangle()) return at(0) * (1 - p.u - p.v) + at(1) * p.u + at(2) * p.v;
    return (at(0) * (1 - p.u) + at(1) * p.u) * (1 - p.v) + (at(3) * (1 - p.u) + at(2) * p.u) * p.v;
}

VertexCoordinates coordinates_at(const Scene& scene, const Patch& patch, Parameters p) {
    using Weights = std::array<float, 4>;
    const Weights weights = patch.is_triangle()
                                ? Weights{1 - p.u - p.v, p.u, p.v}
                                : Weights{(1 - p.u) * (1 - p.v), p.u * (1 - p.v), p.u * p.v, (1 - p.u) * p.v};
    const auto count = static_cast<std::size_t>(patch.vertex_count());
    return interpolated(scene, std::span(patch.vertices).first(count), std::span(weights).first(count));
}

Rgb reflectance_at(const Scene& scene, const Patch& patch, Parameters p) {
    const Material& material = scene.materials[patch.material];
    return times_texel(scene, patch, p, material.reflectance, material.reflectance_texture);
}

Rgb exitance_at(const Scene& scene, const Patch& patch, Parameters p) {
    const Material& material = scene.materials[patch.material];
    return times_texel(scene, patch, p, material.exitance, material.exitance_texture);
}

Rgb transmittance_at(const Scene& scene, const Patch& patch, Parameters p) {
    const Material& material = scene.materials[patch.material];
    return times_texel(scene, patch, p, material.transmittance, material.transmittance_texture);
}

}  // namespace interflect::detail
