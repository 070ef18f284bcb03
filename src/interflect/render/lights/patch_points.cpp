#include "interflect/render/lights/patch_points.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Spherical triangle, in double precision because the angles of small triangles sum to almost 180 degrees.
struct SphericalTriangle {
    V3d a, b, c;      // unit vectors
    double area = 0;  // solid angle [sr]

    SphericalTriangle() = default;
    /// Area by Van Oosterom and Strackee 1983.
    SphericalTriangle(const V3d& va, const V3d& vb, const V3d& vc)
        : a(va.normalized()), b(vb.normalized()), c(vc.normalized()) {
        area = 2 * std::atan2(std::abs(a.dot(b.cross(c))), 1 + a.dot(b) + b.dot(c) + c.dot(a));
    }

    /// Maps the unit square uniformly to the triangle (Arvo 1995).
    V3d direction(double u, double v) const {
        const double cosine_of_side = a.dot(b);
        const V3d to_b = (b - a * cosine_of_side).normalized(), to_c = (c - a * a.dot(c)).normalized();
        const double cosine = std::clamp(to_b.dot(to_c), -1.0, 1.0), sine = std::sqrt(1 - cosine * cosine);
        const double turn = u * area - std::acos(cosine), s = std::sin(turn), t = std::cos(turn);
        const double p = t - cosine, q = s + sine * cosine_of_side, denominator = (q * s + p * t) * sine;
        const double along = denominator != 0 ? std::clamp(((q * t - p * s) * cosine - q) / denominator, -1.0, 1.0) : 1;
        const V3d corner = a * along + to_c * std::sqrt(1 - along * along);
        const double height = 1 - v * (1 - corner.dot(b));
        const V3d across = corner - b * corner.dot(b);
        const double length = across.length();
        return length > 0 ? b * height + across * (std::sqrt(std::max(0.0, 1 - height * height)) / length) : b;
    }
};

/// A patch seen from x.
struct SeenPatch {
    std::array<SphericalTriangle, 2> parts;
    int count = 0;  // number of triangles; 0: the patch is far and sampled by area
    double solid_angle() const { return parts[0].area + parts[1].area; }

    SeenPatch(const PatchGeometry& patch, const V3f& x) {
        constexpr float near = 2;       // [radii]; farther away, squared distances vary by less than (3 / 1)^2
        constexpr double least = 1e-5;  // [sr]; rounding of float vertices dominates smaller angles
        const PatchGeometry::Shape& shape = patch.shape();
        // Squared radius of a sphere that contains the patch.
        const float radius2 = (shape.edge_u.length2() + shape.edge_v.length2()) / 2;
        if ((patch.centre() - x).length2() >= near * near * radius2) return;
        const auto corners = corners_of(patch.is_triangle());
        std::array<V3d, 4> v;
        for (std::size_t i = 0; i < corners.size(); ++i) v[i] = V3d(patch.point(corners[i])) - V3d(x);
        parts[0] = {v[0], v[1], v[2]};
        if (corners.size() == 4) parts[1] = {v[0], v[2], v[3]};
        if (std::isfinite(solid_angle()) && solid_angle() >= least) count = static_cast<int>(corners.size()) - 2;
    }
};

float density_of_area(const PatchGeometry& patch, const V3f& direction, float distance2) {
    const float cosine = -patch.normal().dot(direction);
    return cosine > 0 ? distance2 / (patch.area() * cosine) : 0;
}

}  // namespace

std::optional<PatchPoint> sample_patch(const PatchGeometry& patch, const V3f& x, float u, float v) {
    const V3f n = patch.normal();
    const float height = n.dot(x - patch.shape().origin);
    if (!(height > 0)) return {};
    PatchPoint point;
    const SeenPatch seen(patch, x);
    if (seen.count == 0) {
        point.at = patch.uniform_parameters(u, v);
        const V3f to_light = patch.point(point.at) - x;
        point.distance2 = to_light.length2();
        if (!(point.distance2 > 0)) return {};
        point.direction = to_light / std::sqrt(point.distance2);
        point.density = density_of_area(patch, point.direction, point.distance2);
        if (!(point.density > 0)) return {};
        return point;
    }
    double choice = static_cast<double>(u) * seen.solid_angle();
    const bool is_second = choice >= seen.parts[0].area && seen.count == 2;
    if (is_second) choice -= seen.parts[0].area;
    const SphericalTriangle& part = seen.parts[is_second ? 1 : 0];
    if (!(part.area > 0)) return {};
    point.direction = V3f(part.direction(choice / part.area, static_cast<double>(v)));
    const float towards = -n.dot(point.direction);
    if (!(towards > 0)) return {};
    const float distance = height / towards;
    point.at = patch.parameters_of(x + distance * point.direction);
    point.distance2 = distance * distance;
    point.density = static_cast<float>(1 / seen.solid_angle());
    return point;
}

float patch_density(const PatchGeometry& patch, const V3f& x, const V3f& direction, float distance2) {
    if (!(patch.normal().dot(direction) < 0)) return 0;
    const SeenPatch seen(patch, x);
    return seen.count == 0 ? density_of_area(patch, direction, distance2) : static_cast<float>(1 / seen.solid_angle());
}

}  // namespace interflect::detail
