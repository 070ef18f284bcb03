#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect {

struct ContactOptions {
    /// Distance of touching faces as a fraction of the smaller face's diameter; at least the rounding of vertices.
    float touch_distance = 1e-4f;
    /// Minimum extent of connected segments [m], >= 0; smaller ones are ignored. Faces smaller than its square stay
    /// whole. Twice default_element_size(), the resolution of elements, is suitable.
    float least_extent = 0;
    /// Maximum ratio of length to width of quadrilateral pieces, >= 1. Longer pieces are divided across, unless
    /// narrower than twice `least_extent` or 0.002 of the face's diameter.
    float largest_aspect = 4;
    /// Maximum number of pieces of one face, in (0, 2^31). A face that needs more is cut into fewer.
    std::uint32_t most_pieces_per_face = 1u << 16;
    /// Maximum number of patches of the resulting scene. Further faces stay whole.
    std::uint64_t max_patches = 50'000'000;
};

/// Cuts faces along the segments in which other faces meet them. No element then extends to both sides of a wall or is
/// partly covered. Segments are: an edge on the face (a wall or a leg on a floor); the intersection with a face that
/// passes through it; and the outline of a coplanar face that hides a part of it (paper on a desk; of two, the face of
/// the larger flat surface is cut, see flat_surfaces.h). Contacts behind a one-sided face, segments on the face's own
/// border and faces within one degree of its plane are ignored.
///
/// Each face is cut by a binary space partition in its plane: the line of a segment cuts the whole convex piece that
/// contains it. Pieces are triangles and convex quadrilaterals with the face's material, object, texture and lightmap
/// coordinates; they cover the face exactly (to the rounding of vertices). Patch::surface identifies the original
/// surface. T-vertices may result. Scene::contacts receives the parts of the cuts where other faces meet the face. A
/// warped quadrilateral is cut as the two triangles of the ray caster.
///
/// Lengths below 4e-6 of the face's diameter, or below four roundings of its coordinates, are ignored. The result does
/// not depend on the order of faces or the number of threads.
///
/// @throws InputError for a scene with faults (scene_faults).
/// @return       The scene, with a warning for each limit of `options` reached. Patches keep their order, with pieces
///               in place of their face. O(n log n + k) time for n faces and k pairs of touching faces.
Scene cut_at_contacts(const Scene& scene, const ContactOptions& options = {});

}  // namespace interflect
