#include "interflect/exports/vertices/lit_polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "interflect/base/random.h"
#include "interflect/exports/mesh/display_range.h"
#include "interflect/exports/mesh/element_mesh.h"
#include "interflect/geometry/texture_mapping.h"
#include "interflect/image/srgb.h"

namespace interflect::detail {

namespace {

struct VertexHash {
    std::size_t operator()(const LitPolygons::Vertex& v) const {
        std::uint64_t hash = v.point;
        for (const Rgb& colour : {v.irradiance, v.radiosity})
            for (int c = 0; c < 3; ++c) hash = mix(hash ^ std::bit_cast<std::uint32_t>(colour[c]), 0);
        return hash;
    }
};

}  // namespace

LitPolygons lit_polygons(const Scene& scene, const Solution& solution) {
    return lit_polygons(scene, {solution.forest, ElementMesh(scene, *solution.forest, solution.irradiance), {}});
}

LitPolygons lit_polygons(const Scene& scene, const VertexLight& light) {
    const ElementForest& forest = *light.forest;
    const ElementMesh& mesh = light.mesh;
    LitPolygons polygons;
    polygons.points = mesh.points();
    std::unordered_map<LitPolygons::Vertex, std::uint32_t, VertexHash> numbers;
    for (const std::uint32_t leaf : forest.leaves()) {
        const std::vector<MeshCorner> outline = mesh.outline(leaf);
        if (outline.size() < 3) continue;
        const Patch& patch = scene.patches[forest.patch(leaf)];
        for (const MeshCorner& corner : outline) {
            const Rgb radiosity =
                exitance_at(scene, patch, corner.at) + reflectance_at(scene, patch, corner.at) * corner.irradiance;
            const LitPolygons::Vertex vertex{corner.point, corner.irradiance, radiosity};
            const auto [entry, is_new] =
                numbers.try_emplace(vertex, static_cast<std::uint32_t>(polygons.vertices.size()));
            if (is_new) polygons.vertices.push_back(vertex);
            polygons.corners.push_back(entry->second);
            polygons.parameters.push_back(corner.at);
        }
        polygons.leaves.push_back(leaf);
        polygons.ends.push_back(static_cast<std::uint32_t>(polygons.corners.size()));
    }
    return polygons;
}

std::array<std::uint8_t, 3> display_colour(const Rgb& radiosity, float exposure) {
    const Rgb shown = within_display_range(radiosity * (std::exp2(exposure) / std::numbers::pi_v<float>));
    return {srgb_byte(shown.x), srgb_byte(shown.y), srgb_byte(shown.z)};
}

std::string position_text(const Scene& scene, const V3f& point) {
    if (scene.origin == Imath::V3d(0)) return fmt::format("{} {} {}", point.x, point.y, point.z);
    const Imath::V3d world = scene.origin + Imath::V3d(point);
    return fmt::format("{} {} {}", world.x, world.y, world.z);
}

}  // namespace interflect::detail
