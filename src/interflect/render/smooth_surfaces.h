#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Corners and edges that patches share on smooth surfaces.
struct SmoothSurfaces {
    struct Groups {
        /// Group of corner [4 patch + corner], or of edge [4 patch + corner where it starts in the patch's vertex
        /// order]: 0 ... count - 1. The missing fourth entry of a triangle is none.
        std::vector<std::uint32_t> group;
        std::uint32_t count = 0;
    };
    /// Part of two patches' edges across which the patches continue each other although the edges differ: one end lies
    /// inside the other edge, or a contact covers the rest. Parameters are in [0, 1] in each patch's vertex order;
    /// `from[0]` and `to[1]` are the same point.
    struct Seam {
        std::array<std::uint32_t, 2> edge;  ///< 4 patch + corner where the edge starts.
        std::array<float, 2> from, to;      ///< from < to.
    };
    Groups corners, edges;
    std::vector<Seam> seams;
};

/// Unit normals of all patches, towards their lit sides.
std::vector<V3f> patch_normals(const Scene& scene);

/// Two patches continue each other across a shared edge with the same material, no crease and the same orientation (the
/// edge runs in opposite directions in their vertex orders). A crease is where normals of the scene differ; without
/// them, where the patches' do by more than SmoothingOptions::crease_angle. Corners at the same point are shared along
/// a chain of such patches. Vertices are identical within rounding: 2^-20 of the largest coordinate of core_bounds().
///
/// Patches of a cut surface (Patch::surface) also continue each other and their neighbours across seams, which are
/// parts of edges. No patch continues another across a contact (Scene::contacts). Elsewhere surfaces end at vertices
/// inside another patch's edge. Time O(n log n) for n patches.
SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options = {});

}  // namespace interflect::detail
