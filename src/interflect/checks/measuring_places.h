#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/measure.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Reasons why a measurement at a point is useless.
enum class PointFault {
    none,
    outside,  ///< A quarter of the directions that it faces leave a closed room.
    behind    ///< Most rays from it pass the back of a one-sided face first: it lies inside a solid.
};

/// The fault of each point. Traces 32 rays a point and back; of more than 2048 points it looks at 2048, evenly spaced.
std::vector<PointFault> point_faults(const Scene& scene, const RayCaster& ray_caster,
                                     std::span<const MeasuringPoint> points);

}  // namespace interflect::inline detail
