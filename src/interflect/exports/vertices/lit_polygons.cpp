#include "interflect/exports/vertices/lit_polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <unordered_map>
#include <utility>

#include "interflect/base/numbers/random.h"
#include "interflect/exports/mesh/display_range.h"
#include "interflect/exports/mesh/element_mesh.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/image/codecs/srgb.h"

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

/// Collects polygons, whose equal corners share a vertex.
class Polygons {
  public:
    explicit Polygons(const Scene& scene) : scene_(scene) {}

    void add(const Patch& patch, ElementIndex leaf, std::span<const MeshCorner> outline) {
        for (const MeshCorner& corner : outline) {
            polygons.corners.push_back(number_of(patch, corner));
            polygons.parameters.push_back(corner.at);
        }
        polygons.leaves.push_back(leaf);
        polygons.ends.push_back(static_cast<std::uint32_t>(polygons.corners.size()));
    }

    LitPolygons polygons;

  private:
    std::uint32_t number_of(const Patch& patch, const MeshCorner& corner) {
        const Rgb radiosity =
            exitance_at(scene_, patch, corner.at) + reflectance_at(scene_, patch, corner.at) * corner.irradiance;
        const LitPolygons::Vertex vertex{corner.point, corner.irradiance, radiosity};
        const auto [entry, is_new] = numbers_.try_emplace(vertex, static_cast<std::uint32_t>(polygons.vertices.size()));
        if (is_new) polygons.vertices.push_back(vertex);
        return entry->second;
    }

    const Scene& scene_;
    std::unordered_map<LitPolygons::Vertex, std::uint32_t, VertexHash> numbers_;
};

}  // namespace

LitPolygons lit_polygons(const Scene& scene, const Solution& solution) {
    return lit_polygons(scene, {solution.forest, ElementMesh(scene, *solution.forest, solution.irradiance), {}});
}

LitPolygons lit_polygons(const Scene& scene, const VertexLight& light) {
    Polygons all(scene);
    for (const ElementIndex leaf : light.forest->leaves()) {
        const std::vector<MeshCorner> outline = light.mesh.outline(leaf);
        if (outline.size() >= 3) all.add(scene.patches[light.forest->patch(leaf)], leaf, outline);
    }
    all.polygons.points = light.mesh.points();
    return std::move(all.polygons);
}

LitPolygons lit_triangles(const Scene& scene, VertexLight& light) {
    Polygons all(scene);
    std::vector<MeshTriangle> triangles;
    for (const ElementIndex leaf : light.forest->leaves()) {
        triangles.clear();
        light.mesh.triangulate(leaf, triangles);
        for (const MeshTriangle& triangle : triangles)
            all.add(scene.patches[light.forest->patch(leaf)], leaf, triangle);
    }
    all.polygons.points = light.mesh.points();
    return std::move(all.polygons);
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
