#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Which corners and edges of patches are one and the same in one smooth surface, and so share their values.
struct SmoothSurfaces {
    struct Groups {
        /// [4 patch + corner], or, of edges, [4 patch + the corner where it starts in the patch's vertex order]:
        /// 0 ... count - 1; none for what would be a triangle's fourth.
        std::vector<std::uint32_t> group;
        std::uint32_t count = 0;
    };
    /// A part of two patches' edges across which they continue each other, though the edges are not one: an end of one
    /// lies inside the other, or a contact covers the rest. Parameters run from 0 to 1 along each edge in its patch's
    /// vertex order; `from[0]` is where `to[1]` is.
    struct Seam {
        std::array<std::uint32_t, 2> edge;  ///< 4 patch + the corner where it starts.
        std::array<float, 2> from, to;      ///< from < to.
    };
    Groups corners, edges;
    std::vector<Seam> seams;
};

/// Unit normals of all patches, towards their lit sides.
std::vector<V3f> patch_normals(const Scene& scene);

/// Two patches continue each other across an edge that they share where they are of equal material, there is no crease
/// between them (normals of the scene that differ, else an angle above SmoothingOptions::crease_angle), and they are of
/// one orientation (the edge runs opposite ways in the two patches' vertex orders), so that fronts continue onto fronts
/// and backs onto backs: the edge is one for both. Two corners at the same point are one where a chain of patches leads
/// from one to the other, each continuing the last across an edge at that point. Vertices are the same where their
/// positions are equal to rounding (2^-20 of the scene's largest coordinate).
///
/// Patches of a surface that was cut (Patch::surface) also continue each other, and what they border on, across parts
/// of edges: those are seams. No patch continues another across a contact (Scene::contacts). Elsewhere a vertex of one
/// patch in the middle of another patch's edge is not looked for: there surfaces end. Time O(n log n) in the number of
/// patches n.
SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options = {});

}  // namespace interflect::inline detail
