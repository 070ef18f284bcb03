#pragma once

#include <cstdint>
#include <span>

#include "interflect/base/points.h"
#include "interflect/elements/cell.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/start_points.h"

namespace interflect::inline detail {

/// Generates rays from samples first_sample, first_sample + 1, ... Origins are uniform on the cell, `offset` above the
/// patch. Directions have density cos(theta) / pi about the normal.
/// @param key     Key of the point sequence (fill_points).
/// @param points  Working space.
/// @param rays    Output; its size is the number of rays.
/// @param starts  Points of a leaf to sample as origins (StartPoints::of); empty: uniform origins.
void shoot_rays(const PatchGeometry& patch, const Cell& cell, float offset, PointSet set, std::uint64_t key,
                std::uint64_t first_sample, PointBlock& points, std::span<Ray> rays, std::span<Parameters> origins,
                std::span<const StartPoint> starts = {});

}  // namespace interflect::inline detail
