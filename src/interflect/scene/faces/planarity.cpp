#include "interflect/scene/faces/planarity.h"

#include <algorithm>
#include <cmath>

namespace interflect::detail {

double warp(const Scene& scene, const std::array<std::uint32_t, 4>& vertices) {
    using Imath::V3d;
    const auto corner = [&](std::size_t i) { return V3d(scene.vertices[vertices[i]]); };
    const V3d normal = (corner(2) - corner(0)).cross(corner(3) - corner(1)).normalized();
    return std::abs((corner(1) - corner(0)).dot(normal)) / 2;  // the normal is perpendicular to both diagonals
}

bool is_planar(const Scene& scene, const std::array<std::uint32_t, 4>& vertices) {
    float largest = 0;
    for (const std::uint32_t v : vertices)
        for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(scene.vertices[v][c]));
    return warp(scene, vertices) <= relative_planarity * static_cast<double>(largest);
}

}  // namespace interflect::detail
