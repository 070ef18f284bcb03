#include "interflect/luminaires/opening.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/geometry/textures/tangent_frame.h"

namespace interflect::detail {

namespace {

constexpr float quarter_pi = std::numbers::pi_v<float> / 4;
using Shape = LuminousOpening::Shape;

V3f unit(const V3f& v) { return v.length() > 0 ? v.normalized() : V3f(0); }

V3f along(int axis, float length) {
    V3f v(0);
    v[axis] = length;
    return v;
}

V3f box_faces(const V3f& size, const V3f& d) {
    return {std::abs(d.x) * size.y * size.z, std::abs(d.y) * size.z * size.x, std::abs(d.z) * size.x * size.y};
}

struct CylinderAreas {
    float end, side;
};

/// Returns projected areas. The side's is its height times the width of the ellipse seen along d.
CylinderAreas cylinder_areas(const LuminousOpening& opening, const V3f& d) {
    const int k = opening.axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const V3f& size = opening.size;
    return {std::abs(d[k]) * quarter_pi * size[i] * size[j], size[k] * std::hypot(d[i] * size[j], d[j] * size[i])};
}

Imath::V2f disk_point(float u, float v) {
    const float radius = std::sqrt(u), turn = 8 * quarter_pi * v;
    return {radius * std::cos(turn), radius * std::sin(turn)};
}

OpeningPoint sample_box(const V3f& size, const V3f& d, float u, float v) {
    const V3f faces = box_faces(size, d);
    float at = u * (faces.x + faces.y + faces.z);
    int k = 0;
    while (k < 2 && at >= faces[k]) at -= faces[k++];
    if (!(faces[k] > 0)) return {size * (u - 0.5f), V3f(0)};  // a line or a point
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const float sign = std::copysign(1.0f, d[k]);
    return {along(k, sign * size[k] / 2) + along(i, size[i] * (at / faces[k] - 0.5f)) + along(j, size[j] * (v - 0.5f)),
            along(k, sign)};
}

/// An affine map to radius 1 preserves uniformity in projection.
OpeningPoint sample_cylinder(const LuminousOpening& opening, const V3f& d, float u, float v) {
    const int k = opening.axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const V3f radii = opening.size / 2;
    const auto [end, side] = cylinder_areas(opening, d);
    if (!(radii[i] > 0 && radii[j] > 0)) return sample_box(opening.size, d, u, v);
    const float at = u * (end + side);
    if (at < end || !(side > 0)) {
        const float sign = std::copysign(1.0f, d[k]);
        const Imath::V2f p = disk_point(end > 0 ? std::min(at / end, 1.0f) : u, v);
        return {along(k, sign * radii[k]) + along(i, p.x * radii[i]) + along(j, p.y * radii[j]), along(k, sign)};
    }
    const Imath::V2f towards = Imath::V2f(d[i] / radii[i], d[j] / radii[j]).normalized();
    const float across = 2 * std::min((at - end) / side, 1.0f) - 1,
                front = std::sqrt(std::max(0.0f, 1 - across * across));
    const Imath::V2f p = towards * front + Imath::V2f(-towards.y, towards.x) * across;
    return {along(k, opening.size[k] * (v - 0.5f)) + along(i, p.x * radii[i]) + along(j, p.y * radii[j]),
            unit(along(i, p.x / radii[i]) + along(j, p.y / radii[j]))};
}

OpeningPoint sample_ellipsoid(const V3f& size, const V3f& d, float u, float v) {
    const V3f radii = size / 2, towards = unit(d / radii);
    const TangentFrame frame(towards);
    const Imath::V2f p = disk_point(u, v);
    const V3f on_sphere = frame.s * p.x + frame.t * p.y + towards * std::sqrt(std::max(0.0f, 1 - u));
    return {on_sphere * radii, unit(on_sphere / radii)};
}

}  // namespace

OpeningPoint sample_opening(const LuminousOpening& opening, const V3f& d, float u, float v) {
    switch (opening.shape) {
        case Shape::box:
            return sample_box(opening.size, d, u, v);
        case Shape::cylinder:
            return sample_cylinder(opening, d, u, v);
        case Shape::ellipsoid:
            return sample_ellipsoid(opening.size, d, u, v);
    }
    return {};
}

float projected_area(const LuminousOpening& opening, const V3f& d) {
    const V3f& size = opening.size;
    if (opening.shape == Shape::box) {
        const V3f faces = box_faces(size, d);
        return faces.x + faces.y + faces.z;
    }
    if (opening.shape == Shape::cylinder) {
        const auto [end, side] = cylinder_areas(opening, d);
        return end + side;
    }
    return quarter_pi * V3f(d.x * size.y * size.z, d.y * size.z * size.x, d.z * size.x * size.y).length();
}

LuminaireFrame::LuminaireFrame(const MeasuredLight& light) : z(-light.direction.normalized()) {
    x = (light.c0 - z * z.dot(light.c0)).normalized();
    y = z.cross(x) * (light.mirrored ? -1.0f : 1.0f);
}

}  // namespace interflect::detail
