#include "interflect/elements/texture_means.h"

#include <array>

#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect::detail {

namespace {

/// Number of squares per side into which a non-linear quadrilateral is divided.
constexpr int squares_per_side = 4;
/// Maximum relative twist of a parallelogram.
constexpr float rounding = 1e-5f;

template <class Vector>
bool is_parallelogram(const std::array<Vector, 4>& x) {
    const auto twist = x[0] - x[1] + x[2] - x[3];
    return twist.length() <= rounding * ((x[2] - x[0]).length() + (x[3] - x[1]).length());
}

bool is_linear(const Scene& scene, const Patch& patch) {
    std::array<V3f, 4> corners;
    std::array<V2f, 4> coordinates;
    for (std::size_t k = 0; k < 4; ++k) {
        corners[k] = scene.vertices[patch.vertices[k]];
        coordinates[k] = scene.texture_coordinates[patch.vertices[k]];
    }
    return is_parallelogram(corners) && is_parallelogram(coordinates);
}

/// Returns twice the area of a triangle [m^2]. It is computed from edges, because differences of positions are less
/// accurate.
double doubled_area(const PatchGeometry::Shape& shape, const std::array<Parameters, 3>& p) {
    const auto edge = [&](const Parameters& a, const Parameters& b) {
        const double au = a.u, av = a.v, bu = b.u, bv = b.v;
        return Imath::V3d(shape.edge_u) * (bu - au) + Imath::V3d(shape.edge_v) * (bv - av) +
               Imath::V3d(shape.twist) * (bu * bv - au * av);
    };
    return edge(p[0], p[1]).cross(edge(p[0], p[2])).length();
}

}  // namespace

TextureMeans::TextureMeans(const Scene& scene) : scene_(scene) {
    integrals_.reserve(scene.textures.size());
    for (const Texture& texture : scene.textures) integrals_.emplace_back(texture);
}

Rgb TextureMeans::mean(std::uint32_t texture, const Patch& patch, const PatchGeometry& geometry,
                       const Cell& cell) const {
    if (texture == none) return Rgb(1);
    RgbD sum(0, 0, 0);
    double area = 0;
    const auto add_triangle = [&](const std::array<Parameters, 3>& p) {
        std::array<V2f, 3> coordinates;
        for (std::size_t k = 0; k < 3; ++k) coordinates[k] = texture_coordinate(scene_, patch, p[k]);
        const double weight = doubled_area(geometry.shape(), p);
        sum += RgbD(integrals_[texture].mean(coordinates)) * weight;
        area += weight;
    };
    if (patch.is_triangle()) {
        add_triangle({cell.at(0, 0), cell.at(1, 0), cell.at(0, 1)});
    } else {
        const int n = is_linear(scene_, patch) ? 1 : squares_per_side;
        const float size = 1 / static_cast<float>(n);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const float s = size * static_cast<float>(i), t = size * static_cast<float>(j);
                add_triangle({cell.at(s, t), cell.at(s + size, t), cell.at(s + size, t + size)});
                add_triangle({cell.at(s, t), cell.at(s + size, t + size), cell.at(s, t + size)});
            }
    }
    return Rgb(sum / area);
}

}  // namespace interflect::detail
