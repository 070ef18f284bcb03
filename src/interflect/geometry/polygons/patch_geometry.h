#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/scene.h"
#include "interflect/scene/faces/patch_area.h"

namespace interflect::detail {

/// Parameters u and v of a point x on a patch. On a triangle, x = v0 + u (v1 - v0) + v (v2 - v0) with u, v >= 0 and
/// u + v <= 1. On a quadrilateral, x is bilinear in u and v, with the vertices at (0,0), (1,0), (1,1) and (0,1).
struct Parameters {
    float u = 0, v = 0;
};

/// Parameters of a quadrilateral's vertices.
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
    V3f normal() const { return normal_; }  ///< Returns the unit normal towards the lit side.
    bool is_triangle() const { return triangle_; }
    V3f centre() const;  ///< Returns the mean of the vertices [m].

    const Shape& shape() const { return shape_; }
    V3f point(Parameters p) const { return shape_.point(p); }

    /// Maps (a, b) in the unit square uniformly to the area of the part corner + size (s, t), which is by default the
    /// whole patch.
    Parameters uniform_parameters(float a, float b, Parameters corner = {}, float size = 1) const;

    /// Inverts point() for x near the patch, and clamps the result to the patch.
    Parameters parameters_of(const V3f& x) const;

    /// Moves a point at least `distance` [m] away from the border, or less in narrow patches.
    Parameters inset(Parameters p, float distance) const;

    /// Returns |dx/du x dx/dv| [m^2]. It is linear in u and v, so a cell's area is its area in parameters times the
    /// value at its centre.
    float jacobian(Parameters p) const;

  private:
    Shape shape_;
    V3f normal_;
    V3f inverse_u_, inverse_v_;        // rows of the inverse of (edge_u edge_v)
    std::array<float, 3> jacobian_{};  // jacobian() = [0] + [1] u + [2] v [m^2]
    float area_ = 0;
    bool triangle_ = false, parallelogram_ = false;
};

}  // namespace interflect::detail
