#pragma once

#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render.h"

namespace interflect::detail {

/// Draws the light of the elements, by flat or smooth shading.
/// @param irradiance  H per element [unit of exitance]; only leaves are used.
/// @throws InputError as render() does.
Rendering draw_elements(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster, const View& view,
                        std::span<const Rgb> irradiance, const PictureOptions& options, const Monitor& monitor);

}  // namespace interflect::detail
