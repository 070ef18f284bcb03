#pragma once

#include <vector>

#include "interflect/export.h"
#include "interflect/exports/lightmap_charts.h"
#include "interflect/image.h"

namespace interflect::detail {

struct Lightmap {
    std::vector<LightmapChart> charts;
    std::vector<std::uint32_t> chart_of_patch;  ///< Chart per patch; `none` if it is hidden (shown_patches).
    std::vector<std::uint32_t> index_in_chart;  ///< Index per patch, within its chart.
    std::vector<Image> images;  ///< H [lm/m^2] or L [cd/m^2], see LightmapOptions::content; 0 between charts.
    std::vector<std::vector<Image>> groups;  ///< [group][image]: contributions of light groups.
    double used = 0;                         ///< Share of texels in charts and gutters.
    double covered = 0;                      ///< Share of texels on patches.

    /// Returns coordinates in the image of the chart, (0, 0) at the upper left.
    V2f coordinate(std::uint32_t patch, Parameters at) const;
    int page(std::uint32_t patch) const { return charts[chart_of_patch[patch]].page; }
};

/// Evaluates the light at every texel centre. Texels beyond the patches, as in gutters, use the nearest point of the
/// patches.
/// @param options  Must include a lightmap.
Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
