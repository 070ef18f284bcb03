#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "interflect/geometry/planar_polygon.h"

namespace interflect::detail {

/// Clips `segment` to the polygon's interior.
/// @return  Whether a part at least `tolerance` long and not entirely within `tolerance` of one edge remains; if so, it
///          replaces `segment`.
bool clip_to_interior(const PlanarPolygon& polygon, double tolerance, PlanarSegment& segment);

struct CutPolygon {
    std::vector<PlanarPolygon> pieces;    ///< Convex, any number of corners.
    std::vector<PlanarSegment> contacts;  ///< The segments, moved onto the edges made by the cuts.
    bool reached_limit = false;           ///< Segments still cross some of the pieces.
};

/// Binary space partition of a convex polygon by the lines of segments in its interior. Each line cuts only the piece
/// that contains its segment. Among the longest segments of a piece, the next is the one whose line divides the fewest
/// others.
/// @param tolerance    Width of lines and minimum width of pieces [m].
/// @param most_pieces  > 0.
CutPolygon cut_polygon(PlanarPolygon polygon, std::vector<PlanarSegment> segments, double tolerance,
                       std::size_t most_pieces);

struct PieceShape {
    double largest_aspect = std::numeric_limits<double>::infinity();  ///< Length over width of a quadrilateral.
    double least_width = 0;  ///< Narrower quadrilaterals may have any length [m].
    /// Slivers that are longer are first cut across, whatever their width [m].
    double longest_sliver = std::numeric_limits<double>::infinity();
};

/// Divides a convex polygon into compact triangles and quadrilaterals by diagonals. Cuts long quadrilaterals across,
/// into at most 16 parts, and slivers into at most 64, because quadtree elements inherit the shape of their patch.
void divide_into_patches(const PlanarPolygon& polygon, const PieceShape& shape, std::vector<PlanarPolygon>& patches);

}  // namespace interflect::detail
