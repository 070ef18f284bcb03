#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/numbers/counts.h"
#include "interflect/base/numbers/points.h"
#include "interflect/elements/cell.h"
#include "interflect/elements/forest.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/sampling/ray_allocation.h"
#include "interflect/solver/sampling/ray_plan.h"
#include "interflect/solver/sampling/start_points.h"

namespace interflect::detail {

/// Random sequences of the sources. The sequence of a leaf continues through all iterations.
struct SampleStreams {
    SampleStreams(PointSet set, std::uint64_t run_seed) : points(set), seed(run_seed) {}

    PointSet points;
    std::uint64_t seed;
    Counts used;                               // number of used points of each leaf
    std::vector<std::uint64_t> used_by_parts;  // number of used points of each luminaire part
    std::uint64_t allocations = 0;             // number of allocations so far
};

/// Samples rays with origins `offset` [m] above the patch, uniform on the cell. Directions have the density
/// cos(theta) / pi.
/// @param key     Key of the point sequence (fill_points).
/// @param starts  Origins to sample (StartPoints::of); empty: uniform origins.
void shoot_rays(const PatchGeometry& patch, const Cell& cell, float offset, PointSet set, std::uint64_t key,
                std::uint64_t first_sample, PointBlock& points, std::span<Ray> rays, std::span<Parameters> origins,
                std::span<const StartPoint> starts = {});

/// Rays batch.rays[begin ... end - 1] of one source.
struct SourceRays {
    std::uint32_t source;  ///< Leaf, or size of the forest + luminaire part.
    std::uint32_t begin, end;
};

/// Rays that a thread makes at once.
struct RayBatch {
    std::vector<SourceRays> sources;
    std::vector<Ray> rays;
    std::vector<Parameters> origins;
    PointBlock points;
};

/// Samples the rays of a plan. Refers to its arguments.
class RayMaker {
  public:
    RayMaker(const ElementForest& forest, const RayCaster& ray_caster, const RayPlan& plan,
             const SampleStreams& streams);

    const RayAllocation& allocation() const { return allocation_; }
    std::uint32_t elements() const { return elements_; }

    /// Samples the rays [begin, end) of the plan.
    void make(std::int64_t begin, std::int64_t end, RayBatch& batch) const;

  private:
    void shoot_from_leaf(ElementIndex leaf, std::uint64_t skipped, std::size_t offset, std::size_t length,
                         RayBatch& batch) const;
    void shoot_from_part(std::uint32_t part, std::uint64_t skipped, std::size_t offset, std::size_t length,
                         RayBatch& batch) const;

    const ElementForest& forest_;
    const std::uint32_t elements_;
    const Emission* emission_;
    const StartPoints* start_points_;
    const SampleStreams& streams_;
    const RayCaster& ray_caster_;
    RayAllocation allocation_;
};

/// Marks the samples of an allocation as used.
void advance(SampleStreams& streams, const RayAllocation& allocation, std::size_t elements, std::size_t parts);

}  // namespace interflect::detail
