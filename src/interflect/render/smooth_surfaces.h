#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct SmoothSurfaces {
    struct Groups {
        /// Group in [0, count) of corner, or of the edge that starts there, [4 patch + corner]. Triangles have three.
        std::vector<std::uint32_t> group;
        std::uint32_t count = 0;
    };
    /// Common part of two edges across which their patches continue. One end lies inside the other edge, or a contact
    /// covers the rest. Parameters in [0, 1] in each patch's vertex order; from[0] and to[1] coincide.
    struct Seam {
        std::array<std::uint32_t, 2> edge;  ///< 4 patch + corner where the edge starts.
        std::array<float, 2> from, to;      ///< from < to.
    };
    Groups corners, edges;
    std::vector<Seam> seams;
};

/// Unit normals, towards the lit sides.
std::vector<V3f> patch_normals(const Scene& scene);

/// Patches continue each other across a shared edge with equal material and orientation and without a crease. At a
/// crease, scene normals differ or, without them, patch normals by more than SmoothingOptions::crease_angle. Chains of
/// such patches share corners. Vertices are welded within 2^-20 of the largest coordinate of core_bounds().
///
/// Pieces of a cut surface (Patch::surface) also continue across seams. No patch continues across a contact
/// (Scene::contacts). Other T-junctions are borders. O(n log n).
SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options = {});

}  // namespace interflect::detail
