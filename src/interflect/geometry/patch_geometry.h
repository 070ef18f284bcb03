#pragma once

#include <array>
#include <cstdint>

#include "interflect/scene.h"
#include "interflect/scene/patch_area.h"

namespace interflect::detail {

/// Surface parameters. Triangle: x = v0 + u (v1 - v0) + v (v2 - v0), u, v >= 0, u + v <= 1. Quadrilateral: bilinear,
/// with vertices at (0,0) (1,0) (1,1) (0,1).
struct Parameters {
    float u = 0, v = 0;
};

class PatchGeometry {
  public:
    /// x = origin + u edge_u + v edge_v + u v twist.
    struct Shape {
        V3f origin, edge_u, edge_v, twist{0, 0, 0};

        V3f point(Parameters p) const { return origin + p.u * edge_u + p.v * edge_v + (p.u * p.v) * twist; }
    };

    PatchGeometry() = default;
    PatchGeometry(const Scene& scene, const Patch& patch);

    float area() const { return area_; }    ///< [m^2]
    V3f normal() const { return normal_; }  ///< Unit length, towards the lit side.
    bool is_triangle() const { return triangle_; }
    V3f centre() const;  ///< Mean of the vertices [m].

    const Shape& shape() const { return shape_; }
    V3f point(Parameters p) const { return shape_.point(p); }

    /// Maps uniform (a, b) in the unit square to points uniform over the patch's area, or over its part corner + size
    /// (s, t) with (s, t) in the parameter domain.
    Parameters uniform_parameters(float a, float b, Parameters corner = {}, float size = 1) const;

    /// Inverts point() for x on or near the patch. Clamps to the patch.
    Parameters parameters_of(const V3f& x) const;

    /// Returns |dx/du x dx/dv| [m^2]: 2 area() on a triangle; linear in u and v on a planar quadrilateral. A cell's
    /// area is its size in parameter space times the value at its centre.
    float jacobian(Parameters p) const;

  private:
    Shape shape_;
    V3f normal_;
    V3f inverse_u_, inverse_v_;        // rows of the inverse of (edge_u edge_v), for parallelograms
    std::array<float, 3> jacobian_{};  // constant, u and v coefficients [m^2]
    float area_ = 0;
    bool triangle_ = false, parallelogram_ = false;
};

}  // namespace interflect::detail
