#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "interflect/geometry/planar_polygon.h"

namespace interflect::inline detail {

/// The part of `segment` that runs through the polygon's interior: at least `tolerance` long, and not within
/// `tolerance` of one edge all along.
/// @return  Whether there is one; if so, `segment` becomes it.
bool clip_to_interior(const PlanarPolygon& polygon, double tolerance, PlanarSegment& segment);

/// Result of cut_polygon().
struct CutPolygon {
    std::vector<PlanarPolygon> pieces;    ///< Convex, any number of corners.
    std::vector<PlanarSegment> contacts;  ///< The segments, moved onto the edges that the cuts made.
    bool reached_limit = false;           ///< Segments still run through some of the pieces.
};

/// Binary space partition of a convex polygon by the lines of segments in its interior, each through the piece it lies
/// in. Of the longest segments in a piece, the one whose line divides the fewest others goes first.
/// @param tolerance    [m]: what is closer to a line lies on it, and no piece is thinner.
/// @param most_pieces  > 0.
CutPolygon cut_polygon(PlanarPolygon polygon, std::vector<PlanarSegment> segments, double tolerance,
                       std::size_t most_pieces);

/// Limits of the shape of pieces.
struct PieceShape {
    /// Length over width of a quadrilateral.
    double largest_aspect = std::numeric_limits<double>::infinity();
    double least_width = 0;  ///< Narrower ones may have any length [m].
    /// Longer pieces are first cut across, whatever their width, where they are slivers [m].
    double longest_sliver = std::numeric_limits<double>::infinity();
};

/// Divides a convex polygon into triangles and quadrilaterals by diagonals that leave compact parts, and long
/// quadrilaterals across, into 16 at most, slivers into 64: the quadtree's elements have the shape of their patch.
void divide_into_patches(const PlanarPolygon& polygon, const PieceShape& shape, std::vector<PlanarPolygon>& patches);

}  // namespace interflect::inline detail
