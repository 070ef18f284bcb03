#pragma once

#include <cstddef>
#include <vector>

#include "interflect/geometry/planar_polygon.h"

namespace interflect::inline detail {

/// Clips `segment` to the polygon's interior.
/// @return  Whether the clipped segment is at least `tolerance` long and not entirely within `tolerance` of one edge.
///          If so, `segment` is replaced by it.
bool clip_to_interior(const PlanarPolygon& polygon, double tolerance, PlanarSegment& segment);

/// Result of cut_polygon().
struct CutPolygon {
    std::vector<PlanarPolygon> pieces;    ///< Convex, any number of corners.
    std::vector<PlanarSegment> contacts;  ///< The segments, moved onto the edges made by the cuts.
    bool reached_limit = false;           ///< Segments still cross some of the pieces.
};

/// Binary space partition of a convex polygon by the lines of segments in its interior. Each line cuts only the piece
/// that contains its segment. Among the longest segments of a piece, the one whose line divides the fewest others is
/// used first.
/// @param tolerance    Points closer to a line than this lie on it, and no piece is thinner [m].
/// @param most_pieces  > 0.
CutPolygon cut_polygon(PlanarPolygon polygon, std::vector<PlanarSegment> segments, double tolerance,
                       std::size_t most_pieces);

/// Limits of the shape of pieces.
struct PieceShape {
    double largest_aspect = 4;  ///< Length over width of a quadrilateral.
    double least_width = 0;     ///< Narrower pieces may have any length [m].
};

/// Divides a convex polygon into triangles and quadrilaterals by diagonals that leave compact parts. Cuts long
/// quadrilaterals across, into at most 16 parts, because the elements of the quadtree inherit the shape of their patch.
void divide_into_patches(const PlanarPolygon& polygon, const PieceShape& shape, std::vector<PlanarPolygon>& patches);

}  // namespace interflect::inline detail
