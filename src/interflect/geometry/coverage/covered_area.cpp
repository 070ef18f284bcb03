#include "interflect/geometry/coverage/covered_area.h"

#include <ImathVec.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/polygons/planar_polygon.h"

namespace interflect::detail {

namespace {

using Imath::V2d;
using Imath::V3d;

/// Share of a patch's area that counts as rounding error.
constexpr double negligible_share = 1e-12;
/// A polygon that meets more faces is halved first, because cutting by each in turn multiplies the pieces.
constexpr std::size_t cut_at_once = 4;
/// The smallest parts have 2^-12 of the length and width of the polygon.
constexpr int max_halvings = 24;

double area_of(const PlanarPolygon& polygon) { return 0.5 * doubled_area(polygon); }

PlanarPolygon half_of(const PlanarPolygon& polygon, const V2d& a, const V2d& b, bool left) {
    const V2d along = left ? b - a : a - b;
    PlanarPolygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V2d &p = polygon[i].position, &q = polygon[(i + 1) % polygon.size()].position;
        const double height_p = along.cross(p - a), height_q = along.cross(q - a);
        if (height_p >= 0) result.push_back(polygon[i]);
        if ((height_p > 0 && height_q < 0) || (height_p < 0 && height_q > 0))
            result.push_back({p + (q - p) * (height_p / (height_p - height_q)), none});
    }
    return result;
}

PlanarPolygon intersection(PlanarPolygon polygon, const PlanarPolygon& other) {
    for (std::size_t i = 0; i < other.size() && polygon.size() > 2; ++i)
        polygon = half_of(polygon, other[i].position, other[(i + 1) % other.size()].position, true);
    return polygon;
}

/// Returns a number of intersections that suffices to separate `count` disjoint faces by halving, with some reserve.
std::size_t enough_intersections(std::size_t count) {
    constexpr std::size_t per_level = 4, more_levels = 8, at_least = 1024;
    return at_least + per_level * count * (static_cast<std::size_t>(std::bit_width(count)) + more_levels);
}

/// Returns the area of the polygon outside the others [m^2]. Areas up to `negligible` [m^2] count as 0.
/// @param intersections  Number of intersections that may still be computed. Afterwards, only the face that covers most
///     of a part counts, because the outlines of a thousand nested faces divide each other into a million parts.
double area_outside(const PlanarPolygon& polygon, std::vector<const PlanarPolygon*> others, double negligible,
                    int halvings, std::size_t& intersections) {
    const double area = area_of(polygon);
    if (area <= negligible) return 0;
    const bool is_exhausted = intersections < others.size();
    intersections -= is_exhausted ? intersections : others.size();
    double largest_share = 0;
    std::erase_if(others, [&](const PlanarPolygon* other) {
        const double shared = area_of(intersection(polygon, *other));
        largest_share = std::max(largest_share, shared);
        return shared <= negligible;
    });
    if (area - largest_share <= negligible) return 0;
    if (others.empty()) return area;
    if (is_exhausted) return area - largest_share;
    double outside = 0;
    // Halve the polygon across the longer side of its bounds
    if (others.size() > cut_at_once && halvings < max_halvings) {
        V2d low = polygon[0].position, high = low;
        for (const auto& [p, vertex] : polygon) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        const V2d middle = 0.5 * (low + high), size = high - low;
        const V2d beyond = middle + (size.x > size.y ? V2d(0, size.x) : V2d(size.y, 0));
        for (const bool left : {true, false})
            outside +=
                area_outside(half_of(polygon, middle, beyond, left), others, negligible, halvings + 1, intersections);
        return outside;
    }
    // Cut off the parts outside the edges of one face; the rest is covered
    const PlanarPolygon& first = *others.back();
    others.pop_back();
    PlanarPolygon rest = polygon;
    for (std::size_t i = 0; i < first.size() && rest.size() > 2; ++i) {
        const V2d &a = first[i].position, &b = first[(i + 1) % first.size()].position;
        outside += area_outside(half_of(rest, a, b, false), others, negligible, halvings, intersections);
        rest = half_of(rest, a, b, true);
    }
    return outside;
}

class PatchPlane {
  public:
    PatchPlane(const Scene& scene, const Patch& patch) : scene_(scene), origin_(vertex(patch, 0)) {
        const V3d normal(PatchGeometry(scene, patch).normal());
        s_ = (vertex(patch, 1) - origin_).normalized();
        t_ = normal.cross(s_).normalized();
        s_ = t_.cross(normal).normalized();
    }

    PlanarPolygon polygon_of(const Patch& patch) const {
        PlanarPolygon polygon;
        for (int k = 0; k < patch.vertex_count(); ++k) {
            const V3d d = vertex(patch, k) - origin_;
            polygon.push_back({{s_.dot(d), t_.dot(d)}, none});
        }
        if (area_of(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
        return polygon;
    }

  private:
    V3d vertex(const Patch& patch, int k) const {
        return V3d(scene_.vertices[patch.vertices[static_cast<std::size_t>(k)]]);
    }

    const Scene& scene_;
    V3d origin_, s_, t_;
};

}  // namespace

float uncovered_area_share(const Scene& scene, PatchIndex patch, std::span<const std::uint32_t> others,
                           float tolerance) {
    const PatchPlane plane(scene, scene.patches[patch]);
    const PlanarPolygon polygon = plane.polygon_of(scene.patches[patch]);
    std::vector<PlanarPolygon> polygons;
    polygons.reserve(others.size());
    for (const std::uint32_t other : others) polygons.push_back(plane.polygon_of(scene.patches[other]));
    std::vector<const PlanarPolygon*> pointers;
    pointers.reserve(polygons.size());
    for (const PlanarPolygon& other : polygons) pointers.push_back(&other);
    const double area = area_of(polygon), slivers = static_cast<double>(tolerance) * perimeter(polygon);
    std::size_t intersections = enough_intersections(pointers.size());
    const double outside = area_outside(polygon, pointers, negligible_share * area, 0, intersections);
    if (outside <= slivers) return 0;
    if (area - outside <= slivers) return 1;
    return static_cast<float>(outside / area);
}

}  // namespace interflect::detail
