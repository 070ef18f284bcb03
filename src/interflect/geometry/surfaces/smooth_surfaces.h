#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/geometry/surfaces/corner_index.h"
#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct SmoothSurfaces {
    struct Groups {
        /// Group, from 0 to count - 1, of each corner, or of the edge that starts there; none for the fourth corner of
        /// a triangle.
        std::vector<std::uint32_t> group;
        std::uint32_t count = 0;
    };
    /// Common part of two edges across which their patches continue. The parameters, from 0 to 1, follow each patch's
    /// vertex order, so from[0] and to[1] coincide.
    struct Seam {
        std::array<EdgeIndex, 2> edge;
        std::array<float, 2> from, to;  ///< Parameters along each edge, from < to.
    };
    Groups corners, edges;
    std::vector<Seam> seams;
};

/// Returns unit normals towards the lit sides.
std::vector<V3f> patch_normals(const Scene& scene);

/// Joins patches of equal material and orientation across shared edges: equal scene normals or, without them, patch
/// normals within SmoothingOptions::crease_angle. Pieces of a cut surface (Patch::surface) also join across seams.
/// Contacts (Scene::contacts) and other T-junctions are borders.
SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options = {});

}  // namespace interflect::detail
