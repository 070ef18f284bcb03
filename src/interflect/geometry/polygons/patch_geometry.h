#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/scene.h"
#include "interflect/scene/faces/patch_area.h"

namespace interflect::detail {

/// Surface parameters. Triangle: x = v0 + u (v1 - v0) + v (v2 - v0), u, v >= 0, u + v <= 1. Quadrilateral: bilinear,
/// with vertices at (0,0) (1,0) (1,1) (0,1).
struct Parameters {
    float u = 0, v = 0;
};

/// Corners of the domain, in the order of the vertices.
inline constexpr std::array<Parameters, 4> square_corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
inline constexpr std::array<Parameters, 3> triangle_corners{{{0, 0}, {1, 0}, {0, 1}}};
inline std::span<const Parameters> corners_of(bool is_triangle) {
    return is_triangle ? std::span<const Parameters>(triangle_corners) : std::span<const Parameters>(square_corners);
}

class PatchGeometry {
  public:
    struct Shape {
        V3f origin, edge_u, edge_v, twist{0, 0, 0};

        V3f point(Parameters p) const { return origin + p.u * edge_u + p.v * edge_v + (p.u * p.v) * twist; }
    };

    PatchGeometry() = default;
    PatchGeometry(const Scene& scene, const Patch& patch);

    float area() const { return area_; }    ///< [m^2]
    V3f normal() const { return normal_; }  ///< Towards the lit side.
    bool is_triangle() const { return triangle_; }
    V3f centre() const;  ///< Mean of the vertices [m].

    const Shape& shape() const { return shape_; }
    V3f point(Parameters p) const { return shape_.point(p); }

    /// Maps the unit square (a, b) uniformly to the area of the part corner + size (s, t), by default the patch.
    Parameters uniform_parameters(float a, float b, Parameters corner = {}, float size = 1) const;

    /// Inverts point() for x near the patch; clamps to it.
    Parameters parameters_of(const V3f& x) const;

    /// Moves a point to at least `distance` [m] from the border, less in narrow patches.
    Parameters inset(Parameters p, float distance) const;

    /// Returns |dx/du x dx/dv| [m^2]. Linear in u and v: a cell's area is its parameter area times the value at its
    /// centre.
    float jacobian(Parameters p) const;

  private:
    Shape shape_;
    V3f normal_;
    V3f inverse_u_, inverse_v_;        // rows of the inverse of (edge_u edge_v)
    std::array<float, 3> jacobian_{};  // constant, u and v coefficients [m^2]
    float area_ = 0;
    bool triangle_ = false, parallelogram_ = false;
};

}  // namespace interflect::detail
