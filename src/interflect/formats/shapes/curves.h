#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace interflect::detail {

struct PolygonMesh {
    std::vector<Imath::V3d> points;
    std::vector<std::vector<std::uint32_t>> faces;  ///< Counter-clockwise seen from the front.
};

struct Tessellation {
    int divisions = 4;  ///< Flat pieces per quarter circle, >= 1.
    /// Increases the radii until the facets have the area of the curved surface: exitance times area is then the exact
    /// power of a light. Otherwise the corners lie on the curved surface, where other faces may touch it, and the
    /// facets have less area: 3.2% less on a sphere and 2.6% on a ring of four divisions.
    bool keeps_area = false;
};

// Curved surfaces of MGF. Faces are planar, with the front outside, or inside for negative radii.
// @throws std::invalid_argument for arguments out of range.

/// @param radius  Not 0.
PolygonMesh make_sphere(const Imath::V3d& centre, double radius, const Tessellation& tessellation);

/// The ends are open. @param radius1, radius2  Not both 0, not of opposite sign.
PolygonMesh make_cone(const Imath::V3d& end1, double radius1, const Imath::V3d& end2, double radius2,
                      const Tessellation& tessellation);

/// @param normal  Unit length. @param inner, outer  0 <= inner < outer.
PolygonMesh make_ring(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer,
                      const Tessellation& tessellation);

/// @param normal  Unit length.
/// @param inner, outer  Distances from axis to tube: inner * outer >= 0, |inner| < |outer|.
PolygonMesh make_torus(const Imath::V3d& centre, const Imath::V3d& normal, double inner, double outer,
                       const Tessellation& tessellation);

/// Makes a closed prism. It extends by `length` behind the outline or, if negative, to the front with inward faces.
PolygonMesh make_prism(std::span<const Imath::V3d> outline, double length);

}  // namespace interflect::detail
