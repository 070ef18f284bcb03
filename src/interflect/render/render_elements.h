#pragma once

#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render.h"

namespace interflect::detail {

/// Draws as render() does, for any irradiance H per element [unit of exitance]; only leaves are used.
/// @throws InputError as render() does, and for inconsistent sizes.
Rendering render(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                 std::span<const Rgb> irradiance, const PictureOptions& options = {}, const Monitor& monitor = {});

}  // namespace interflect::detail
