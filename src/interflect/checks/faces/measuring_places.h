#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/measure.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

enum class PointFault {
    none,
    outside,  ///< A quarter of its front directions leave a closed room.
    behind    ///< Inside a solid: most rays first pass the back of a one-sided face.
};

/// Traces 32 rays and their reversed rays for at most 2048 evenly spaced points.
std::vector<PointFault> point_faults(const Scene& scene, const RayCaster& ray_caster,
                                     std::span<const MeasuringPoint> points);

}  // namespace interflect::detail
