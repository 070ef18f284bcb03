#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/points.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/ray_allocation.h"
#include "interflect/solver/transport.h"

namespace interflect::inline detail {

/// Rays of one task with the same source: batch.rays[begin ... end - 1].
struct SourceRays {
    std::uint32_t source;  ///< Leaf, or size of the forest + luminaire part.
    std::uint32_t begin, end;
};

/// Rays of one task; one object per thread, reused.
struct RayBatch {
    std::vector<SourceRays> sources;
    std::vector<Ray> rays;
    std::vector<Parameters> origins;
    PointBlock points;
};

/// Generates the rays of a step. Refers to its arguments.
class RayMaker {
  public:
    RayMaker(const ElementForest& forest, const RayCaster& ray_caster, const TransportStep& step,
             const SampleStreams& streams);

    const RayAllocation& allocation() const { return allocation_; }
    std::uint32_t elements() const { return elements_; }  ///< Size of the forest before the step.

    void make(std::int64_t begin, std::int64_t end, RayBatch& batch) const;

  private:
    void shoot_from_leaf(std::uint32_t leaf, std::uint64_t skipped, std::size_t offset, std::size_t length,
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

}  // namespace interflect::inline detail
