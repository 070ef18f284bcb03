#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "interflect/geometry/polygons/planar_polygon.h"

namespace interflect::detail {

/// Clips `segment` to the polygon's interior. Returns false, unchanged, if the rest is shorter than `tolerance` [m] or
/// along an edge.
bool clip_to_interior(const PlanarPolygon& polygon, double tolerance, PlanarSegment& segment);

struct CutPolygon {
    std::vector<PlanarPolygon> pieces;    ///< Convex.
    std::vector<PlanarSegment> contacts;  ///< Moved onto the cuts.
    bool reached_limit = false;           ///< Segments still cross some pieces.
};

/// Partitions a convex polygon by segments in its interior (BSP).
/// @param tolerance  Width of lines and minimum width of pieces [m].
/// @param max_pieces  > 0.
CutPolygon cut_polygon(PlanarPolygon polygon, std::vector<PlanarSegment> segments, double tolerance,
                       std::size_t max_pieces);

struct PieceShape {
    double largest_aspect = std::numeric_limits<double>::infinity();  ///< Length over width of a quadrilateral.
    double min_width = 0;  ///< Narrower quadrilaterals may have any length [m].
    /// Longer slivers are cut across first [m].
    double longest_sliver = std::numeric_limits<double>::infinity();
};

/// Divides long quadrilaterals into at most 16 parts, slivers into at most 64: elements inherit the shape of patches.
void divide_into_patches(const PlanarPolygon& polygon, const PieceShape& shape, std::vector<PlanarPolygon>& patches);

}  // namespace interflect::detail
