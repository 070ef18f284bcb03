#include "interflect/geometry/polygons/patch_geometry.h"

#include <algorithm>
#include <cmath>

namespace interflect::detail {

namespace {

/// Twist relative to the edges, up to which a quadrilateral counts as a parallelogram.
constexpr float parallelogram_tolerance = 1e-5f;

/// Inverts the cumulative distribution of the density (a + b x) / (a + b / 2) on [0, 1]; a, a + b >= 0.
float warp_linear(float a, float b, float uniform) {
    // Avoids cancellation for small b.
    const float target = uniform * (a + 0.5f * b);
    const float root = std::sqrt(std::max(0.0f, a * a + 2 * b * target));
    return a + root > 0 ? std::clamp(2 * target / (a + root), 0.0f, 1.0f) : uniform;
}

}  // namespace

PatchGeometry::PatchGeometry(const Scene& scene, const Patch& patch) : triangle_(patch.is_triangle()) {
    std::array<V3f, 4> x;
    const auto count = static_cast<std::size_t>(patch.vertex_count());
    for (std::size_t i = 0; i < count; ++i) x[i] = scene.vertices[patch.vertices[i]];
    const V3f area_vector = 0.5f * doubled_area_vector<float>({x.data(), count});
    normal_ = area_vector.normalized();
    area_ = area_vector.length();
    shape_.origin = x[0];
    shape_.edge_u = x[1] - x[0];
    shape_.edge_v = x[count - 1] - x[0];
    if (triangle_) {
        jacobian_ = {2 * area_, 0, 0};
        parallelogram_ = true;  // x is affine in (u, v)
    } else {
        shape_.twist = x[2] - x[1] - shape_.edge_v;
        // The u v term is zero for a planar quadrilateral.
        jacobian_ = {normal_.dot(shape_.edge_u.cross(shape_.edge_v)), normal_.dot(shape_.edge_u.cross(shape_.twist)),
                     normal_.dot(shape_.twist.cross(shape_.edge_v))};
        parallelogram_ =
            shape_.twist.length() <= parallelogram_tolerance * (shape_.edge_u.length() + shape_.edge_v.length());
    }
    const V3f n = shape_.edge_u.cross(shape_.edge_v);
    const float n2 = n.length2();
    if (n2 > 0) {
        inverse_u_ = shape_.edge_v.cross(n) / n2;
        inverse_v_ = n.cross(shape_.edge_u) / n2;
    }
}

V3f PatchGeometry::centre() const {
    return triangle_ ? shape_.origin + (shape_.edge_u + shape_.edge_v) / 3.0f : point({0.5f, 0.5f});
}

float PatchGeometry::jacobian(Parameters p) const { return jacobian_[0] + p.u * jacobian_[1] + p.v * jacobian_[2]; }

Parameters PatchGeometry::uniform_parameters(float a, float b, Parameters corner, float size) const {
    Parameters local{a, b};
    if (triangle_) {
        // Area-preserving map (Heitz 2019, 'A Low-Distortion Map').
        if (b > a)
            local = {0.5f * a, b - 0.5f * a};
        else
            local = {a - 0.5f * b, 0.5f * b};
    } else if (!parallelogram_) {
        // Samples u from its marginal density, the Jacobian at the middle of v, then v given u.
        const auto density = [&](float s, float t) {
            return std::max(0.0f, jacobian({corner.u + size * s, corner.v + size * t}));
        };
        local.u = warp_linear(density(0, 0.5f), size * jacobian_[1], a);
        local.v = warp_linear(density(local.u, 0), size * jacobian_[2], b);
    }
    return {corner.u + size * local.u, corner.v + size * local.v};
}

Parameters PatchGeometry::inset(Parameters p, float distance) const {
    const auto share = [&](const V3f& edge) { return std::min(distance / edge.length(), 0.25f); };
    const float u = share(shape_.edge_u), v = share(shape_.edge_v);
    p = {std::clamp(p.u, u, 1 - u), std::clamp(p.v, v, 1 - v)};
    if (!triangle_) return p;
    const float excess = std::max(0.0f, p.u + p.v - (1 - u - v)) / 2;
    return {std::max(p.u - excess, u / 2), std::max(p.v - excess, v / 2)};
}

Parameters PatchGeometry::parameters_of(const V3f& x) const {
    const V3f d = x - shape_.origin;
    Parameters p{inverse_u_.dot(d), inverse_v_.dot(d)};
    if (!parallelogram_) {
        // Solves d = u edge_u + v edge_v + u v twist for v. This root stays finite for a vanishing twist.
        using Imath::V3d;
        const V3d n(normal_), h(d), e(shape_.edge_u), f(shape_.edge_v), g(shape_.twist);
        const auto cross = [&](const V3d& a, const V3d& b) { return n.dot(a.cross(b)); };
        const double square = cross(g, f), linear = cross(e, f) + cross(h, g), constant = cross(h, e);
        const double root = std::sqrt(std::max(0.0, linear * linear - 4 * constant * square));
        const double v = linear + root > 0 ? std::clamp(-2 * constant / (linear + root), 0.0, 1.0) : 0;
        const V3d along = e + v * g, from = h - v * f;
        const double length2 = along.dot(along);
        p = {static_cast<float>(length2 > 0 ? from.dot(along) / length2 : 0), static_cast<float>(v)};
    }
    p.u = std::clamp(p.u, 0.0f, 1.0f);
    p.v = std::clamp(p.v, 0.0f, triangle_ ? 1.0f - p.u : 1.0f);
    return p;
}

}  // namespace interflect::detail

namespace interflect {

V3f patch_normal(const Scene& scene, const Patch& patch) { return detail::PatchGeometry(scene, patch).normal(); }

}  // namespace interflect
