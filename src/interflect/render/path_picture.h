#pragma once

#include "interflect/path_tracer.h"
#include "interflect/render/path_wavefront.h"

namespace interflect {

/// Traces the paths of a picture, in rounds where there is a target: what trace_paths() and gather() have in common.
/// @param known  The solution that paths end at; null: none.
PathTracing trace_picture(const Scene& scene, const RayCaster& ray_caster, const View& view, const PathOptions& options,
                          const PathMonitor& monitor, const KnownLight* known);

}  // namespace interflect
