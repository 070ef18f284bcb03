#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/measure.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Reasons why a measurement at a point is useless.
enum class PointFault {
    none,
    outside,  ///< A quarter of the directions on its front side leave a closed room.
    behind    ///< Inside a solid: most rays from it first pass the back of a one-sided face.
};

/// Traces 32 rays per point and back, for at most 2048 points, evenly spaced.
std::vector<PointFault> point_faults(const Scene& scene, const RayCaster& ray_caster,
                                     std::span<const MeasuringPoint> points);

}  // namespace interflect::detail
