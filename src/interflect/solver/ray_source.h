#pragma once

#include <cstdint>
#include <span>

#include "interflect/base/points.h"
#include "interflect/elements/cell.h"
#include "interflect/geometry/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/start_points.h"

namespace interflect::inline detail {

/// Makes the rays that samples first_sample, first_sample + 1, ... of a patch stand for: origins uniform on its area
/// and `offset` above it, directions with density cos(theta) / pi about its normal.
/// @param key     Names the patch's point sequence (fill_points).
/// @param points  Working space.
/// @param rays    Receives the rays; its size is their number.
/// @param starts  Points of a leaf (StartPoints::of) that origins are chosen from; empty: uniform ones.
void shoot_rays(const PatchGeometry& patch, const Cell& cell, float offset, PointSet set, std::uint64_t key,
                std::uint64_t first_sample, PointBlock& points, std::span<Ray> rays, std::span<Parameters> origins,
                std::span<const StartPoint> starts = {});

}  // namespace interflect::inline detail
