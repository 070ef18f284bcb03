#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Limit of the crossings of an outline. Each crossing becomes a vertex, and a star of 1,023 corners can have 520,000.
inline constexpr std::size_t max_crossings_per_corner = 4;

enum class PolygonResult {
    added,
    degenerate,     ///< Not added, because it is narrower than the rounding of its vertices.
    self_crossing,  ///< Not added, because opposite areas cancel or edges cross too often (max_crossings_per_corner).
};

/// Adds triangles and convex planar quadrilaterals (planarity.h) as one patch; triangulates others. Keeps the
/// vertex order; merges consecutive vertices at one position. Omits patches below smallest_face_area, and degenerate
/// triangles.
/// @param loops      Outline, counter-clockwise from the front, then holes in any direction (even-odd rule). Doubled
///     edges may join outline and hole. Crossings become new vertices with interpolated attributes.
/// @param two_sided  Adds a back after each front, in reverse order from the same vertex.
PolygonResult add_polygon(Scene& scene, std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material,
                          std::uint32_t object, bool two_sided);

}  // namespace interflect::detail
