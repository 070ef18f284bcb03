#include "interflect/photometry/planar_outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace interflect::detail {

namespace {

using V2d = Imath::V2d;
using V3d = Imath::V3d;

/// Tolerance of distances, relative to the size of the area. It exceeds the rounding of vertices.
constexpr double on_line = 1e-5;

double tolerance_of(const Imath::Box2d& box) { return on_line * (box.max - box.min).length(); }

/// Returns the convex hull, counter-clockwise, by Andrew's monotone chain.
std::vector<V2d> convex_hull(std::vector<V2d> points) {
    std::sort(points.begin(), points.end(),
              [](const V2d& a, const V2d& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<V2d> hull;
    const auto add_side = [&hull](auto begin, auto end) {
        const std::size_t fixed = hull.size();
        for (auto p = begin; p != end; ++p) {
            while (hull.size() >= fixed + 2 &&
                   (hull.back() - hull[hull.size() - 2]).cross(*p - hull[hull.size() - 2]) <= 0)
                hull.pop_back();
            hull.push_back(*p);
        }
        hull.pop_back();
    };
    add_side(points.begin(), points.end());
    add_side(points.rbegin(), points.rend());
    return hull;
}

V2d turned(const V2d& p, double angle) {
    return {p.x * std::cos(angle) + p.y * std::sin(angle), p.y * std::cos(angle) - p.x * std::sin(angle)};
}

Imath::Box2d turned_box(const std::vector<V2d>& points, double angle) {
    Imath::Box2d box;
    for (const V2d& p : points) box.extendBy(turned(p, angle));
    return box;
}

/// Returns the angle of the smallest enclosing rectangle, in [-pi/4, pi/4] [rad]; 0 if the gain is negligible.
double angle_of_smallest_rectangle(const std::vector<V2d>& hull) {
    constexpr double quarter = std::numbers::pi / 2, better = 1 - 1e-4;
    const auto area = [&](double angle) {
        const V2d size = turned_box(hull, angle).size();
        return size.x * size.y;
    };
    double best = 0, smallest = area(0);
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const V2d side = hull[(i + 1) % hull.size()] - hull[i];
        const double angle = std::remainder(std::atan2(side.y, side.x), quarter), a = area(angle);
        if (a >= better * smallest) continue;
        best = angle;
        smallest = a;
    }
    return best;
}

/// Interval of a segment, as distances from its start [m].
using Interval = std::pair<double, double>;

/// Clips a segment to a convex, counter-clockwise face that is enlarged by a margin. If the segment is outside, the
/// result has first > second.
Interval part_within(const std::vector<V2d>& face, const PlanarSegment& segment, double margin) {
    const V2d along = (segment.b - segment.a) / segment.length();
    Interval part{0, segment.length()};
    for (std::size_t i = 0; i < face.size(); ++i) {
        const V2d side = face[(i + 1) % face.size()] - face[i];
        const double from_side = side.cross(segment.a - face[i]) + margin * side.length(), change = side.cross(along);
        if (std::abs(change) <= on_line * side.length()) {
            if (from_side < 0) return {1, 0};
        } else if (change > 0) {
            part.first = std::max(part.first, -from_side / change);
        } else {
            part.second = std::min(part.second, -from_side / change);
        }
    }
    return part;
}

/// Adds the parts of an edge that no face covers: no face has an opposite edge there or extends across the edge.
void add_uncovered(const std::vector<std::vector<V2d>>& faces, const PlanarSegment& edge, double tolerance,
                   std::vector<PlanarSegment>& border) {
    const double length = edge.length();
    const V2d along = (edge.b - edge.a) / length, outwards = V2d(along.y, -along.x) * (3 * tolerance);
    const PlanarSegment beyond{edge.a + outwards, edge.b + outwards};
    std::vector<Interval> covered;
    for (const std::vector<V2d>& face : faces) {
        for (std::size_t i = 0; i < face.size(); ++i) {
            const V2d c = face[i] - edge.a, d = face[(i + 1) % face.size()] - edge.a;
            if (std::abs(along.cross(c)) <= tolerance && std::abs(along.cross(d)) <= tolerance)
                covered.emplace_back(along.dot(d), along.dot(c));
        }
        covered.push_back(part_within(face, beyond, -tolerance));
    }
    std::erase_if(covered, [](const Interval& part) { return part.second <= part.first; });
    std::sort(covered.begin(), covered.end());
    covered.emplace_back(length, length);
    double from = 0;
    for (const auto& [begin, end] : covered) {
        const double to = std::min(begin, length);
        if (to > from + 4 * tolerance) border.push_back({edge.a + along * from, edge.a + along * to});
        from = std::max(from, end);
    }
}

}  // namespace

PlanarOutline outline_of(const Scene& scene, const PlanarArea& area) {
    const V3d n = V3d(area.normal).normalized();
    constexpr double nearly_vertical = 0.9;
    const V3d up = std::abs(n.z) > nearly_vertical ? V3d(0, 1, 0) : V3d(0, 0, 1);
    PlanarOutline outline;
    outline.v = (up - n * n.dot(up)).normalized();
    outline.u = outline.v.cross(n);
    const auto in_world = [&](std::uint32_t vertex) { return scene.origin + V3d(scene.vertices[vertex]); };
    outline.origin = in_world(scene.patches[area.patches.front()].vertices[0]);
    std::vector<V2d> corners;
    for (const PatchIndex i : area.patches) {
        const Patch& patch = scene.patches[i];
        std::vector<V2d>& face = outline.faces.emplace_back();
        for (std::size_t k = 0; k < static_cast<std::size_t>(patch.vertex_count()); ++k) {
            const V3d d = in_world(patch.vertices[k]) - outline.origin;
            face.emplace_back(outline.u.dot(d), outline.v.dot(d));
        }
        corners.insert(corners.end(), face.begin(), face.end());
    }
    const double angle = angle_of_smallest_rectangle(convex_hull(corners));
    const V3d u = outline.u, v = outline.v;
    outline.u = u * std::cos(angle) + v * std::sin(angle);
    outline.v = v * std::cos(angle) - u * std::sin(angle);
    for (std::vector<V2d>& face : outline.faces)
        for (V2d& p : face) outline.box.extendBy(p = turned(p, angle));
    return outline;
}

bool PlanarOutline::holds(const V2d& p) const {
    const double tolerance = tolerance_of(box);
    return std::any_of(faces.begin(), faces.end(), [&](const std::vector<V2d>& face) {
        for (std::size_t i = 0; i < face.size(); ++i) {
            const V2d& a = face[i];
            const V2d side = face[(i + 1) % face.size()] - a;
            if (side.cross(p - a) < -tolerance * side.length()) return false;
        }
        return true;
    });
}

std::vector<PlanarSegment> PlanarOutline::border() const {
    const double tolerance = tolerance_of(box);
    std::vector<PlanarSegment> border;
    for (const std::vector<V2d>& face : faces)
        for (std::size_t i = 0; i < face.size(); ++i) {
            const PlanarSegment edge{face[i], face[(i + 1) % face.size()]};
            if (edge.length() > tolerance) add_uncovered(faces, edge, tolerance, border);
        }
    return border;
}

double distance(const V2d& p, const PlanarSegment& s) {
    const V2d side = s.b - s.a;
    const double length2 = side.length2(), t = length2 > 0 ? std::clamp((p - s.a).dot(side) / length2, 0.0, 1.0) : 0;
    return (p - (s.a + side * t)).length();
}

}  // namespace interflect::detail
