#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace interflect::inline detail {

/// Surface of flat polygons with shared points.
struct PolygonMesh {
    std::vector<Imath::V3d> points;
    std::vector<std::vector<std::uint32_t>> faces;  ///< Indices of points, counter-clockwise seen from the front.
};

// Curved surfaces and the prism of MGF. Points lie on the true surface, with `divisions` (>= 1) steps per quarter
// circle, as in MGF's own parser. A circle of radius r becomes a polygon of circumference 8 d sin(pi / 4d) r, 0.6%
// short at d = 4. Faces are triangles at a pole and planar quadrilaterals elsewhere. The front is outside; negative
// radii turn it inside.
//
// All functions throw std::invalid_argument with a sentence if MGF forbids the arguments.

/// Makes a sphere with its poles on the z axis. @param radius  Not 0.
PolygonMesh make_sphere(const Imath::V3d& centre, double radius, int divisions);

/// Makes a right cone or cylinder with open ends, about the line from `end1` to `end2`.
/// @param radius1, radius2  Not both 0, and not of different signs.
PolygonMesh make_cone(const Imath::V3d& end1, double radius1, const Imath::V3d& end2, double radius2, int divisions);

/// Makes a disk or flat ring whose front faces along `normal`. @param inner, outer  0 <= inner < outer.
PolygonMesh make_ring(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer, int divisions);

/// Makes a torus.
/// @param inner, outer  Distances from the axis to the near and far side of the tube: same sign (inner may be 0) and
///                      |inner| < |outer|.
PolygonMesh make_torus(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer, int divisions);

/// Makes a closed prism: the polygon, its copy at distance `length` behind it, and the walls. If `length` is negative,
/// the copy is in front and all faces point inwards. @param outline  At least three points that enclose an area.
PolygonMesh make_prism(std::span<const Imath::V3d> outline, double length);

}  // namespace interflect::inline detail
