#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect {

struct ContactOptions {
    /// Faces closer than this share of the smaller one's diameter touch; never less than the rounding of vertices.
    float touch_distance = 1e-4f;
    /// Connected segments that extend over less than this are ignored, and faces of a smaller area than its square stay
    /// whole [m], >= 0. Twice default_element_size() is a good value: elements resolve no less.
    float least_extent = 0;
    /// Quadrilateral pieces that are longer than this times their width are divided across, >= 1; not those narrower
    /// than twice `least_extent` or 0.002 of the face's diameter.
    float largest_aspect = 4;
    /// Most pieces of one face, in (0, 2^31); a face that needs more is cut into fewer.
    std::uint32_t most_pieces_per_face = 1u << 16;
    /// Most patches of the resulting scene; once there, further faces stay whole.
    std::uint64_t max_patches = 50'000'000;
};

/// Cuts faces along the segments in which other faces meet them, so that no element lies on both sides of a wall or is
/// partly covered: an edge that lies on the face (a wall or a leg on a floor), the intersection with a face that passes
/// through it, and the outline of a coplanar face that hides a part of it (paper on a desk; of two, the face of the
/// larger flat surface is cut, see flat_surfaces.h). What touches a one-sided face from behind does not count, neither
/// do segments on the face's own border nor faces within a degree of its plane.
///
/// Each face is cut by a binary space partition in its plane: a cut runs along the line of a segment through the whole
/// convex piece that the segment lies in. Pieces are triangles and convex quadrilaterals with the face's material,
/// object and coordinates in textures and lightmaps; they cover it exactly (to the rounding of vertices).
/// Patch::surface tells what was one surface. Vertices may lie in the middle of a neighbour's edge. Scene::contacts
/// gets the parts of the cuts on which other faces do meet the face. A warped quadrilateral is cut as the two triangles
/// that the ray caster takes it for.
///
/// Lengths below 4e-6 of the face's diameter, or below four roundings of its coordinates, are ignored: nothing thinner
/// is cut off. Neither the order of faces nor the number of threads matters.
///
/// @throws InputError for a scene with faults (scene_faults).
/// @return       The scene, with a warning where a limit of `options` was reached. Patches keep their order, pieces in
///               place of their face. O(n log n + k) time for n faces and k pairs of faces that touch.
Scene cut_at_contacts(const Scene& scene, const ContactOptions& options = {});

}  // namespace interflect
