#pragma once

#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render.h"

namespace interflect::detail {

// render() and gather() for any irradiance H per element [unit of exitance]; only leaves are used. InputError also for
// inconsistent sizes.

Rendering render(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                 std::span<const Rgb> irradiance, const RenderOptions& options = {}, const Monitor& monitor = {});

PathTracing gather(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                   std::span<const Rgb> irradiance, const PathOptions& options = {}, const Monitor& monitor = {});

}  // namespace interflect::detail
