#include "interflect/geometry/polygons/outline_crossings.h"

#include <ImathVec.h>

#include <algorithm>
#include <cmath>

namespace interflect::detail {

namespace {

using Imath::V2d;

struct FlatEdge {
    V2d begin, end;
    double low_x() const { return std::min(begin.x, end.x); }
    double high_x() const { return std::max(begin.x, end.x); }
    double low_y() const { return std::min(begin.y, end.y); }
    double high_y() const { return std::max(begin.y, end.y); }
};

/// Returns the edges, projected along the largest component of the normal.
std::vector<FlatEdge> edges_of(const Scene& scene, std::span<const std::vector<std::uint32_t>> loops,
                               const V3f& normal) {
    int largest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[largest])) largest = k;
    const int x = (largest + 1) % 3, y = (largest + 2) % 3;
    const auto flat = [&](std::uint32_t v) { return V2d(scene.vertices[v][x], scene.vertices[v][y]); };
    std::vector<FlatEdge> edges;
    for (const std::vector<std::uint32_t>& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            edges.push_back({flat(loop[i]), flat(loop[(i + 1) % loop.size()])});
    return edges;
}

/// Whether a and b lie strictly on different sides of the line of an edge.
bool separates(const FlatEdge& edge, const V2d& a, const V2d& b) {
    const V2d along = edge.end - edge.begin;
    return along.cross(a - edge.begin) * along.cross(b - edge.begin) < 0;
}

bool cross(const FlatEdge& a, const FlatEdge& b) {
    return a.low_y() <= b.high_y() && b.low_y() <= a.high_y() && separates(a, b.begin, b.end) &&
           separates(b, a.begin, a.end);
}

}  // namespace

bool has_more_crossings(const Scene& scene, std::span<const std::vector<std::uint32_t>> loops, const V3f& normal,
                        std::size_t most) {
    std::vector<FlatEdge> edges = edges_of(scene, loops, normal);
    std::sort(edges.begin(), edges.end(), [](const FlatEdge& a, const FlatEdge& b) { return a.low_x() < b.low_x(); });
    std::size_t crossings = 0;
    for (auto a = edges.begin(); a != edges.end(); ++a)
        for (auto b = a + 1; b != edges.end() && b->low_x() <= a->high_x(); ++b)
            if (cross(*a, *b) && ++crossings > most) return true;
    return false;
}

}  // namespace interflect::detail
