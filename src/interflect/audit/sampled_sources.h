#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Seed and number of the rays of find_escapes() and find_one_way_light().
inline constexpr std::uint64_t audit_seed = 1;
inline constexpr std::int64_t audit_rays = 1 << 16;

/// Leaves sampled systematically in proportion to their power.
struct SampledSources {
    std::vector<ElementIndex> leaves;
    double power = 0;  ///< Total power, sum of the channels.

    double power_of_each() const { return power / static_cast<double>(leaves.size()); }
};

/// Samples leaves. @throws InputError for a ray caster or a solution of another scene.
SampledSources sample_sources(const Scene& scene, const RayCaster& ray_caster, const Solution& solution);

/// Samples a ray from a leaf. @param sample  Index of the ray's random numbers. @param points  Working memory.
Ray ray_from(ElementIndex leaf, const ElementForest& forest, const RayCaster& ray_caster, std::uint64_t sample,
             PointBlock& points);

}  // namespace interflect::detail
