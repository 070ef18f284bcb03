#pragma once

#include <span>

#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {
class ElementForest;
}  // namespace interflect::inline detail

namespace interflect {

/// Final gathering (Reichert 1992; Jensen 1996): a picture of a solution with the light computed per pixel. At the hits
/// of camera rays, direct light is sampled as by trace_paths(): emitting patches and luminaires in proportion to their
/// unoccluded contribution. Indirect light is gathered by cosine-distributed rays, which end at the radiosity rho H of
/// the element hit. If that element fills too large a solid angle, as in corners, the path continues as in path
/// tracing. Contact shadows are therefore sharp, and the mesh affects only a small fraction of indirect light. For
/// finer elements the picture converges to trace_paths().
/// @param forest      Of the same scene, as is `ray_caster`.
/// @param irradiance  H of every element, in the unit of the materials' exitance; only leaves are used.
/// @param options     Of path tracing; `samples` are gathered directions per pixel.
/// @return            The standard error excludes the solution's own error.
/// @throws InputError as trace_paths() does, and for inconsistent sizes and a forest of another scene.
PathTracing gather(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                   std::span<const Rgb> irradiance, const PathOptions& options = {}, const PathMonitor& monitor = {});
/// The same for a solution of the scene.
PathTracing gather(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const PathOptions& options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
