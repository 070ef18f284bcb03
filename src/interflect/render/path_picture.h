#pragma once

#include <span>

#include "interflect/elements/forest.h"
#include "interflect/path_tracer.h"

namespace interflect::inline detail {

/// Irradiance of every element, at which final gathering ends its paths.
struct KnownIrradiance {
    const ElementForest& forest;
    std::span<const Rgb> irradiance;
};

/// Traces the paths of a picture, in rounds where there is a target: what trace_paths() and gather() have in common.
/// @param known  Null: paths go on until roulette ends them.
PathTracing trace_picture(const Scene& scene, const RayCaster& ray_caster, const View& view, const PathOptions& options,
                          const PathMonitor& monitor, const KnownIrradiance* known);

}  // namespace interflect::inline detail
