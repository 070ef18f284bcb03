#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "interflect/exports/vertices/vertex_light.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Leaves as convex polygons, or as triangles, without T-junctions (ElementMesh); equal corners share a vertex.
struct LitPolygons {
    struct Vertex {
        std::uint32_t point;
        Rgb irradiance;  ///< H [lm/m^2 or W/m^2].
        Rgb radiosity;   ///< B = M + rho H [unit of H], textures included.
        bool operator==(const Vertex&) const = default;
    };

    std::vector<V3f> points;  ///< Relative to Scene::origin [m].
    std::vector<Vertex> vertices;
    std::vector<ElementIndex> leaves;    ///< Of each polygon.
    std::vector<std::uint32_t> ends;     ///< End of each polygon in `corners`.
    std::vector<std::uint32_t> corners;  ///< Into `vertices`, counter-clockwise seen from the lit side.
    std::vector<Parameters> parameters;

    std::size_t size() const { return leaves.size(); }
    std::uint32_t begin(std::size_t polygon) const { return polygon == 0 ? 0 : ends[polygon - 1]; }
};

/// Omits leaves without area.
LitPolygons lit_polygons(const Scene& scene, const VertexLight& light);
/// The same, with leaves cut into triangles. Adds points to the mesh.
LitPolygons lit_triangles(const Scene& scene, VertexLight& light);
/// Polygons of the solution's elements.
LitPolygons lit_polygons(const Scene& scene, const Solution& solution);

/// Returns radiance times 2^exposure, within_display_range(), as 8-bit sRGB. @param radiosity  [lm/m^2 or W/m^2]
std::array<std::uint8_t, 3> display_colour(const Rgb& radiosity, float exposure);

/// Formats world coordinates [m] with the fewest identifying digits.
std::string position_text(const Scene& scene, const V3f& point);

template <class Number>
void append_bytes(std::string& bytes, Number number) {
    static_assert(std::endian::native == std::endian::little);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace interflect::detail
