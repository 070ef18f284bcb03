#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Corners and edges of patches that are identical on one smooth surface and share their values.
struct SmoothSurfaces {
    struct Groups {
        /// Group of corner [4 patch + corner], or of edge [4 patch + corner where it starts in the patch's vertex
        /// order]: 0 ... count - 1. The missing fourth entry of a triangle is none.
        std::vector<std::uint32_t> group;
        std::uint32_t count = 0;
    };
    /// Part of two patches' edges across which the patches continue each other although the edges differ: an end of one
    /// edge lies inside the other, or a contact covers the rest. Parameters run from 0 to 1 along each edge in its
    /// patch's vertex order. `from[0]` and `to[1]` are the same point.
    struct Seam {
        std::array<std::uint32_t, 2> edge;  ///< 4 patch + corner where the edge starts.
        std::array<float, 2> from, to;      ///< from < to.
    };
    Groups corners, edges;
    std::vector<Seam> seams;
};

/// Finds the smooth surfaces of a scene. Two patches continue each other across a shared edge if they have the same
/// material, no crease between them, and the same orientation: the edge runs in opposite directions in the two vertex
/// orders. Fronts then continue fronts, and the patches share the edge. Two corners at the same point are shared
/// if a chain of patches connects them, each continuing the previous one across an edge at that point. Vertices are
/// identical if their positions agree within rounding (2^-20 of the largest coordinate of the scene's core_bounds()).
///
/// Patches of a cut surface (Patch::surface) also continue each other and their neighbours across parts of edges, which
/// are called seams. No patch continues another across a contact (Scene::contacts). Other vertices inside another
/// patch's edge are not searched for: surfaces end there. Time O(n log n) for n patches.
SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options = {});

}  // namespace interflect::inline detail
