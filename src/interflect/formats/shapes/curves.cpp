#include "interflect/formats/shapes/curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace interflect::detail {

namespace {

using Imath::V3d;

struct ProfilePoint {
    double radius = 0;
    double height = 0;
};

/// Maximum relative radius of a pole.
constexpr double pole = 1e-12;

V3d perpendicular(const V3d& axis) {
    const V3d a(std::abs(axis.x), std::abs(axis.y), std::abs(axis.z));
    const V3d smallest = a.x <= a.y && a.x <= a.z ? V3d(1, 0, 0) : a.y <= a.z ? V3d(0, 1, 0) : V3d(0, 0, 1);
    return smallest.cross(axis).normalized();
}

double angle_of_step(int step, int steps_per_quarter) { return step * std::numbers::pi / (2.0 * steps_per_quarter); }

void reverse_faces(PolygonMesh& mesh) {
    for (auto& face : mesh.faces) std::reverse(face.begin(), face.end());
}

/// Returns half the angle that a facet spans around the axis [rad].
double half_step(int divisions) { return std::numbers::pi / (4.0 * divisions); }

/// Returns the area of the facets that revolve() makes between two points of a profile.
double facet_area(const ProfilePoint& a, const ProfilePoint& b, int divisions) {
    const double angle = half_step(divisions);
    const double slant = std::hypot(b.height - a.height, (b.radius - a.radius) * std::cos(angle));
    return 4 * divisions * std::sin(angle) * (a.radius + b.radius) * slant;
}

/// Scales a profile, which is closed if its ends meet, about the centre until its facets have this area.
void scale_to_area(std::span<ProfilePoint> profile, bool closed, double area, int divisions) {
    double facets = 0;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < profile.size(); ++i)
        facets += facet_area(profile[i], profile[(i + 1) % profile.size()], divisions);
    for (ProfilePoint& p : profile) {
        p.radius *= std::sqrt(area / facets);
        p.height *= std::sqrt(area / facets);
    }
}

/// Increases the radii of a truncated cone until its facets have the area of the curved surface. Keeps its height.
void widen_to_area(ProfilePoint& a, ProfilePoint& b, int divisions) {
    // The scale s of the radii solves s k sqrt(h^2 + (s d cos)^2) = sqrt(h^2 + d^2), which is quadratic in s^2. Here k
    // is the ratio of chord to arc, h the height and d the difference of the radii.
    const double angle = half_step(divisions);
    const double k = std::sin(angle) / angle;
    const double height = b.height - a.height, difference = b.radius - a.radius;
    const double slant = std::hypot(height, difference);
    const double linear = k * k * height * height;
    const double root = std::hypot(linear, 2 * k * std::cos(angle) * difference * slant);
    const double scale = slant * std::sqrt(2 / (linear + root));
    a.radius *= scale;
    b.radius *= scale;
}

/// Rotates a profile about an axis. Faces point outwards if the profile ascends.
PolygonMesh revolve(std::span<const ProfilePoint> profile, bool closed, const V3d& centre, const V3d& axis,
                    int divisions) {
    const auto around = static_cast<std::uint32_t>(4 * divisions);
    const V3d u = perpendicular(axis), v = axis.cross(u);
    double largest = 0;
    for (const ProfilePoint& p : profile) largest = std::max(largest, p.radius);

    // Add a ring of points, or a pole, for each point of the profile
    PolygonMesh mesh;
    std::vector<std::uint32_t> first_point;
    std::vector<bool> is_pole;
    for (const ProfilePoint& p : profile) {
        first_point.push_back(static_cast<std::uint32_t>(mesh.points.size()));
        is_pole.push_back(p.radius <= pole * largest);
        const V3d level = centre + p.height * axis;
        if (is_pole.back()) {
            mesh.points.push_back(level);
            continue;
        }
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle = angle_of_step(static_cast<int>(i), divisions);
            mesh.points.push_back(level + p.radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }
    // Connect neighbouring rings
    const auto point = [&](std::size_t ring, std::uint32_t i) {
        return first_point[ring] + (is_pole[ring] ? 0 : i % around);
    };
    for (std::size_t ring = 0; ring + (closed ? 0 : 1) < profile.size(); ++ring) {
        const std::size_t next = (ring + 1) % profile.size();
        for (std::uint32_t i = 0; i < around; ++i) {
            std::vector<std::uint32_t> face{point(ring, i)};
            if (!is_pole[ring]) face.push_back(point(ring, i + 1));
            if (!is_pole[next]) face.push_back(point(next, i + 1));
            face.push_back(point(next, i));
            mesh.faces.push_back(std::move(face));
        }
    }
    return mesh;
}

}  // namespace

PolygonMesh make_sphere(const V3d& centre, double radius, const Tessellation& tessellation) {
    if (radius == 0) throw std::invalid_argument("the radius of a sphere must not be 0");
    const int divisions = tessellation.divisions;
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= 2 * divisions; ++i) {
        const double angle = angle_of_step(i, divisions);
        profile.push_back({std::abs(radius) * std::sin(angle), -std::abs(radius) * std::cos(angle)});
    }
    if (tessellation.keeps_area) scale_to_area(profile, false, 4 * std::numbers::pi * radius * radius, divisions);
    PolygonMesh mesh = revolve(profile, false, centre, V3d(0, 0, 1), divisions);
    if (radius < 0) reverse_faces(mesh);
    return mesh;
}

PolygonMesh make_cone(const V3d& end1, double radius1, const V3d& end2, double radius2,
                      const Tessellation& tessellation) {
    if (radius1 == 0 && radius2 == 0) throw std::invalid_argument("the radii of a cone must not both be 0");
    if (radius1 * radius2 < 0) throw std::invalid_argument("the radii of a cone must not differ in sign");
    const double length = (end2 - end1).length();
    if (!(length > 0)) throw std::invalid_argument("the ends of a cone or cylinder must not be at one place");
    ProfilePoint profile[] = {{std::abs(radius1), 0}, {std::abs(radius2), length}};
    if (tessellation.keeps_area) widen_to_area(profile[0], profile[1], tessellation.divisions);
    PolygonMesh mesh = revolve(profile, false, end1, (end2 - end1) / length, tessellation.divisions);
    if (radius1 < 0 || radius2 < 0) reverse_faces(mesh);
    return mesh;
}

PolygonMesh make_ring(const V3d& centre, const V3d& normal, double inner, double outer,
                      const Tessellation& tessellation) {
    if (!(0 <= inner && inner < outer)) throw std::invalid_argument("a ring needs radii 0 <= inner < outer");
    ProfilePoint profile[] = {{outer, 0}, {inner, 0}};
    if (tessellation.keeps_area) widen_to_area(profile[0], profile[1], tessellation.divisions);
    return revolve(profile, false, centre, normal, tessellation.divisions);
}

PolygonMesh make_torus(const V3d& centre, const V3d& normal, double inner, double outer,
                       const Tessellation& tessellation) {
    if (inner * outer < 0 || !(std::abs(inner) < std::abs(outer)))
        throw std::invalid_argument("a torus needs radii of one sign, the first smaller than the second");
    const int divisions = tessellation.divisions;
    const double tube = 0.5 * (std::abs(outer) - std::abs(inner)), middle = 0.5 * (std::abs(outer) + std::abs(inner));
    std::vector<ProfilePoint> profile;
    for (int i = 0; i < 4 * divisions; ++i) {
        const double angle = angle_of_step(i, divisions);
        profile.push_back({std::max(0.0, middle + tube * std::cos(angle)), tube * std::sin(angle)});
    }
    constexpr double area_of_unit_radii = 4 * std::numbers::pi * std::numbers::pi;
    if (tessellation.keeps_area) scale_to_area(profile, true, area_of_unit_radii * middle * tube, divisions);
    PolygonMesh mesh = revolve(profile, true, centre, normal, divisions);
    if (outer < 0) reverse_faces(mesh);
    return mesh;
}

PolygonMesh make_prism(std::span<const V3d> outline, double length) {
    if (length == 0) throw std::invalid_argument("the length of a prism must not be 0");
    V3d area(0);
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
        area += (outline[i] - outline[0]).cross(outline[i + 1] - outline[0]);
    if (!(area.length() > 0)) throw std::invalid_argument("the outline of a prism must enclose an area");
    const V3d behind = area.normalized() * -length;

    PolygonMesh mesh;
    mesh.points.assign(outline.begin(), outline.end());
    for (const V3d& p : outline) mesh.points.push_back(p + behind);
    const auto n = static_cast<std::uint32_t>(outline.size());
    std::vector<std::uint32_t> near_end, far_end;
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t next = (i + 1) % n;
        mesh.faces.push_back({n + i, n + next, next, i});
        near_end.push_back(i);
        far_end.push_back(2 * n - 1 - i);
    }
    mesh.faces.push_back(std::move(near_end));
    mesh.faces.push_back(std::move(far_end));
    return mesh;
}

}  // namespace interflect::detail
