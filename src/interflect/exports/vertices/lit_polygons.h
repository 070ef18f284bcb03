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

/// Leaves as convex polygons or triangles, without T-junctions (ElementMesh). Equal corners share a vertex.
struct LitPolygons {
    struct Vertex {
        std::uint32_t point;  ///< Index into `points`.
        Rgb irradiance;       ///< Irradiance H [lm/m^2 or W/m^2].
        Rgb radiosity;        ///< Radiosity B = M + rho H, with textures [unit of H].
        bool operator==(const Vertex&) const = default;
    };

    std::vector<V3f> points;  ///< Relative to Scene::origin [m].
    std::vector<Vertex> vertices;
    std::vector<ElementIndex> leaves;    ///< Leaf of each polygon.
    std::vector<std::uint32_t> ends;     ///< End of each polygon in `corners`.
    std::vector<std::uint32_t> corners;  ///< Indices of `vertices`, counter-clockwise as seen from the lit side.
    std::vector<Parameters> parameters;  ///< Position of each corner on its patch.

    std::size_t size() const { return leaves.size(); }
    std::uint32_t begin(std::size_t polygon) const { return polygon == 0 ? 0 : ends[polygon - 1]; }
};

/// Returns the leaves as polygons. Omits leaves without area.
LitPolygons lit_polygons(const Scene& scene, const VertexLight& light);
/// Returns the leaves cut into triangles. Adds points to the mesh.
LitPolygons lit_triangles(const Scene& scene, VertexLight& light);
/// Returns the leaves of a solution as polygons.
LitPolygons lit_polygons(const Scene& scene, const Solution& solution);

/// Returns radiance x 2^exposure as 8-bit sRGB, scaled by within_display_range(). @param radiosity  [lm/m^2 or W/m^2]
std::array<std::uint8_t, 3> display_colour(const Rgb& radiosity, float exposure);

/// Formats world coordinates [m] with the smallest number of digits that identify them.
std::string position_text(const Scene& scene, const V3f& point);

/// Appends a number in little-endian byte order.
template <class Number>
void append_bytes(std::string& bytes, Number number) {
    static_assert(std::endian::native == std::endian::little);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace interflect::detail
