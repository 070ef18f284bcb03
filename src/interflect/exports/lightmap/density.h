#pragma once

#include <span>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/charts/charts.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Returns the resolution of packed charts on their objects. @param scene  The solved scene.
std::vector<ObjectDensity> densities_of(std::span<const LightmapChart> charts, const Scene& scene);

/// Draws squares in the colours of LightmapContent::density into charts and their gutters.
void draw_density(std::span<const LightmapChart> charts, const LightmapOptions& options, std::vector<Image>& images);

/// Warns about each object whose charts have been reduced to fit into an image.
void warn_of_reduced_density(std::span<const ObjectDensity> densities, Warnings& warnings);

}  // namespace interflect::detail
