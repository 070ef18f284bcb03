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

/// Final gathering (Reichert 1992; Jensen 1996): a picture of a solution in which every pixel finds its own light.
/// Where the camera's rays arrive, direct light is sampled as by trace_paths(), emitting patches and luminaires in
/// proportion to what they would cause there unoccluded; indirect light is gathered by rays in cosine-distributed
/// directions, which end at the radiosity rho H of the element that they hit. Elements that fill too large a solid
/// angle are not trusted, as in corners: there the path goes on as in path tracing. So shadows at contacts are sharp,
/// and what is left of the mesh is a small share of indirect light; with finer elements the picture tends to that of
/// trace_paths().
/// @param forest      Of the same scene, as is `ray_caster`.
/// @param irradiance  H of every element, in the unit of the materials' exitance; only those of leaves count.
/// @param options     Of path tracing: `samples` are gathered directions a pixel.
/// @return            Its standard error is that of gathering; the solution's own comes on top of it.
/// @throws InputError as trace_paths() does, and for sizes that disagree and a forest of another scene.
PathTracing gather(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                   std::span<const Rgb> irradiance, const PathOptions& options = {}, const PathMonitor& monitor = {});
/// The same of a solution of the scene.
PathTracing gather(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                   const PathOptions& options = {}, const PathMonitor& monitor = {});

}  // namespace interflect
