#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace interflect::detail {

/// Polygon mesh with shared points.
struct PolygonMesh {
    std::vector<Imath::V3d> points;
    std::vector<std::vector<std::uint32_t>> faces;  ///< Counter-clockwise seen from the front.
};

// MGF's curved surfaces and prism. Points lie on the true surface, with `divisions` (>= 1) steps per quarter circle as
// in MGF's parser. A circle's circumference becomes 8 d sin(pi / 4d) r, 0.6% short at d = 4. Faces are triangles at
// poles and planar quadrilaterals elsewhere. The front is outside; negative radii turn it inside. All functions throw
// std::invalid_argument for arguments that MGF forbids.

/// Makes a sphere with poles on the z axis. @param radius  Not 0.
PolygonMesh make_sphere(const Imath::V3d& centre, double radius, int divisions);

/// Makes a cone or cylinder without caps. @param radius1, radius2  Not both 0, not of opposite sign.
PolygonMesh make_cone(const Imath::V3d& end1, double radius1, const Imath::V3d& end2, double radius2, int divisions);

/// Makes a flat ring or disk facing `normal`. @param inner, outer  0 <= inner < outer.
PolygonMesh make_ring(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer, int divisions);

/// Makes a torus. @param inner, outer  Distances from the axis to the tube: same sign, |inner| < |outer|; inner may be
/// 0.
PolygonMesh make_torus(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer, int divisions);

/// Makes a closed prism that extends by `length` behind `outline`. If `length` is negative, it extends to the front and
/// faces inwards. @param outline  At least three points that enclose an area.
PolygonMesh make_prism(std::span<const Imath::V3d> outline, double length);

}  // namespace interflect::detail
