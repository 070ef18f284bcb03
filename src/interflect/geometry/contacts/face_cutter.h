#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "interflect/geometry/polygons/planar_polygon.h"

namespace interflect::detail {

/// Clips `segment` to the polygon's interior. If the rest is shorter than `tolerance` [m] or lies along an edge, leaves
/// the segment unchanged and returns false.
bool clip_to_interior(const PlanarPolygon& polygon, double tolerance, PlanarSegment& segment);

struct CutPolygon {
    std::vector<PlanarPolygon> pieces;    ///< Convex parts of the polygon.
    std::vector<PlanarSegment> contacts;  ///< The given segments, moved onto the cuts.
    bool reached_limit = false;           ///< Whether segments still cross some pieces.
};

/// Partitions a convex polygon by segments in its interior (BSP).
/// @param tolerance  Width of lines and minimum width of pieces [m].
/// @param max_pieces  Limit of the number of pieces, at least 1.
CutPolygon cut_polygon(PlanarPolygon polygon, std::vector<PlanarSegment> segments, double tolerance,
                       std::size_t max_pieces);

struct PieceShape {
    double largest_aspect =
        std::numeric_limits<double>::infinity();  ///< Maximum ratio of a quadrilateral's length to its width.
    double min_width = 0;                         ///< Width below which a quadrilateral may have any length [m].
    /// Length above which slivers are first cut across [m].
    double longest_sliver = std::numeric_limits<double>::infinity();
};

/// Divides a long quadrilateral into at most 16 parts and a sliver into at most 64, because elements inherit the shape
/// of their patch.
void divide_into_patches(const PlanarPolygon& polygon, const PieceShape& shape, std::vector<PlanarPolygon>& patches);

}  // namespace interflect::detail
