#include "interflect/geometry/polygons/triangle_pairs.h"

#include <ImathVec.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "interflect/geometry/polygons/vertex_coordinates.h"
#include "interflect/scene/faces/planarity.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Minimum sine of the angle by which a quadrilateral's outline turns at a corner.
constexpr double min_turn = 0.1;

/// Maximum distance of a texture or lightmap coordinate from a linear map of the quadrilateral.
constexpr double coordinate_tolerance = 1e-4;

class PairFinder {
  public:
    PairFinder(const Scene& scene, std::span<const std::uint32_t> triangles)
        : scene_(scene), triangles_(triangles), faces_(triangles.size() / 3) {
        for (std::uint32_t t = 0; t < faces_.size(); ++t) faces_[t] = {corner(t, 0), corner(t, 1), corner(t, 2), none};
    }

    std::vector<FaceVertices> find() {
        pair_neighbours_in_order();
        const std::vector<TriangleEdge> edges = open_edges();
        pair_along(edges, true);
        pair_along(edges, false);
        std::erase_if(faces_, [](const FaceVertices& face) { return face[0] == none; });
        return std::move(faces_);
    }

  private:
    std::uint32_t corner(std::uint32_t triangle, std::uint32_t k) const { return triangles_[3 * triangle + k % 3]; }
    V3d position(std::uint32_t vertex) const { return V3d(scene_.vertices[vertex]); }
    bool is_single(std::uint32_t triangle) const { return faces_[triangle][0] != none && faces_[triangle][3] == none; }
    double squared_length(std::uint32_t triangle, std::uint32_t k) const {
        return (position(corner(triangle, k + 1)) - position(corner(triangle, k))).length2();
    }
    bool is_longest(std::uint32_t triangle, std::uint32_t k) const {
        const double length = squared_length(triangle, k);
        return length >= squared_length(triangle, k + 1) && length >= squared_length(triangle, k + 2);
    }

    /// Pairs each triangle with the next one. Exporters write the two triangles of a face in sequence, so most pairs
    /// are found without a search.
    void pair_neighbours_in_order() {
        for (std::uint32_t t = 0; t + 1 < faces_.size(); ++t)
            for (std::uint32_t i = 0; i < 3 && is_single(t); ++i)
                for (std::uint32_t j = 0; j < 3 && is_single(t); ++j) pair(t, i, t + 1, j, true);
    }

    std::vector<TriangleEdge> open_edges() const {
        std::vector<TriangleEdge> edges;
        for (std::uint32_t t = 0; t < faces_.size(); ++t) {
            if (!is_single(t)) continue;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const auto [low, high] = std::minmax({corner(t, k), corner(t, k + 1)});
                edges.push_back({std::uint64_t{low} << 32 | high, t, k});
            }
        }
        std::sort(edges.begin(), edges.end(), [](const TriangleEdge& a, const TriangleEdge& b) {
            return std::pair(a.vertices, a.triangle) < std::pair(b.vertices, b.triangle);
        });
        return edges;
    }

    void pair_along(std::span<const TriangleEdge> edges, bool longest_only) {
        for_pairs_at_edges(edges, [&](const TriangleEdge& a, const TriangleEdge& b) {
            pair(a.triangle, a.corner, b.triangle, b.corner, longest_only);
        });
    }

    /// Merges triangles t and u if edge i of t is edge j of u and the result is a valid face.
    void pair(std::uint32_t t, std::uint32_t i, std::uint32_t u, std::uint32_t j, bool longest_only) {
        if (!is_single(t) || !is_single(u)) return;
        if (corner(t, i) != corner(u, j + 1) || corner(t, i + 1) != corner(u, j)) return;
        if (longest_only && !(is_longest(t, i) && is_longest(u, j))) return;
        const FaceVertices merged{corner(t, i), corner(u, j + 2), corner(t, i + 1), corner(t, i + 2)};
        if (!is_planar_and_convex(merged) || !has_linear_coordinates(merged)) return;
        faces_[std::min(t, u)] = merged;
        faces_[std::max(t, u)] = {none, none, none, none};
    }

    /// @param face  Quadrilateral whose vertices [0] and [2] are joined by the shared edge.
    bool is_planar_and_convex(const FaceVertices& face) const {
        const V3d a = position(face[0]), b = position(face[1]), c = position(face[2]), d = position(face[3]);
        const V3d normal = (c - a).cross(d - a).normalized();
        if (!is_planar(scene_, face)) return false;
        const auto turns = [&](const V3d& in, const V3d& out) {
            return in.cross(out).dot(normal) > min_turn * in.length() * out.length();
        };
        return turns(a - d, b - a) && turns(b - a, c - b) && turns(c - b, d - c) && turns(d - c, a - d);
    }

    bool has_linear_coordinates(const FaceVertices& face) const {
        const V3d a = position(face[0]), along = position(face[2]) - a, up = position(face[3]) - a;
        const V3d normal = along.cross(up), b = position(face[1]) - a;
        const double s = b.cross(up).dot(normal) / normal.length2(), t = along.cross(b).dot(normal) / normal.length2();
        const auto is_linear = [&](const std::vector<V2f>& coordinates) {
            const auto of = [&](std::size_t k) { return Imath::V2d(coordinates[face[k]]); };
            const Imath::V2d linear = of(0) + s * (of(2) - of(0)) + t * (of(3) - of(0));
            return (linear - of(1)).length() <= coordinate_tolerance;
        };
        return (scene_.texture_coordinates.empty() || is_linear(scene_.texture_coordinates)) &&
               (!coordinates_of(scene_, face[0]).lightmap || is_linear(scene_.lightmap_coordinates));
    }

    const Scene& scene_;
    std::span<const std::uint32_t> triangles_;
    std::vector<FaceVertices> faces_;  // one per triangle; vertex 0 is `none` after a merge into another triangle
};

}  // namespace

std::vector<FaceVertices> merge_triangle_pairs(const Scene& scene, std::span<const std::uint32_t> triangles) {
    return PairFinder(scene, triangles).find();
}

}  // namespace interflect::detail
