#pragma once

#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render.h"

namespace interflect::detail {

// render() and gather() for any irradiance of the elements.
// @param forest      Of the same scene, as is `ray_caster`.
// @param irradiance  H of every element, in the unit of the materials' exitance; only leaves are used.
// @throws InputError also for inconsistent sizes.

Rendering render(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                 std::span<const Rgb> irradiance, const RenderOptions& options = {}, const Monitor& monitor = {});

PathTracing gather(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                   std::span<const Rgb> irradiance, const PathOptions& options = {}, const Monitor& monitor = {});

}  // namespace interflect::detail
