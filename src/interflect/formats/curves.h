#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace interflect::inline detail {

/// A surface made of flat polygons that share points.
struct PolygonMesh {
    std::vector<Imath::V3d> points;
    std::vector<std::vector<std::uint32_t>> faces;  ///< Indices of points, counter-clockwise seen from the front.
};

// MGF's curved surfaces and its prism. Points lie on the true surface, at `divisions` (>= 1) steps per quarter circle,
// as MGF's own parser has it; so a circle of radius r becomes a polygon of circumference 8 d sin(pi / 4d) r, 0.6% short
// at d = 4. Faces are triangles at a pole and planar quadrilaterals elsewhere. The front is outside; negative radii
// turn it inside.
//
// All throw std::invalid_argument, with a sentence, where MGF calls the arguments illegal.

/// Poles on the z axis. @param radius  Not 0.
PolygonMesh make_sphere(const Imath::V3d& centre, double radius, int divisions);

/// A right cone or cylinder, open at its ends, about the line from `end1` to `end2`.
/// @param radius1, radius2  Not both 0, and not of different signs.
PolygonMesh make_cone(const Imath::V3d& end1, double radius1, const Imath::V3d& end2, double radius2, int divisions);

/// A disk or flat ring whose front is towards `normal`. @param inner, outer  0 <= inner < outer.
PolygonMesh make_ring(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer, int divisions);

/// @param inner, outer  Distances from the axis to the near and the far side of the tube: of one sign (inner may be 0),
///                      and |inner| < |outer|.
PolygonMesh make_torus(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer, int divisions);

/// A closed prism: the polygon, its copy `length` behind it, and the walls between. Where `length` is negative the copy
/// is in front, and all faces look inwards. @param outline  Three points or more that enclose an area.
PolygonMesh make_prism(std::span<const Imath::V3d> outline, double length);

}  // namespace interflect::inline detail
