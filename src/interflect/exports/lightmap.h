#pragma once

#include <vector>

#include "interflect/export.h"
#include "interflect/exports/lightmap_charts.h"
#include "interflect/image.h"

namespace interflect::inline detail {

/// The light of a solved scene in images.
struct Lightmap {
    std::vector<LightmapChart> charts;
    std::vector<std::uint32_t> chart_of_patch;  ///< Of each patch; none where it is not shown (shown_patches).
    std::vector<std::uint32_t> index_in_chart;  ///< Of each patch among those of its chart.
    std::vector<Image> images;  ///< H [lm/m^2] or L [cd/m^2], see LightmapOptions::content; 0 between the charts.
    std::vector<std::vector<Image>> groups;  ///< [group][image]: the share of each light group, see LightmapOptions.
    double used = 0;                         ///< Share of the texels that belong to a chart or to its gutter.
    double covered = 0;                      ///< Share of the texels that lie on a chart's patches.

    /// Coordinates of a point of a patch in the image of its chart, (0, 0) at the upper left.
    V2f coordinate(std::uint32_t patch, Parameters at) const;
    int page(std::uint32_t patch) const { return charts[chart_of_patch[patch]].page; }
};

/// Evaluates the light at the centre of every texel, on the surface of its chart; where that is beyond the patches, as
/// in the gutters, at the nearest point of them.
/// @param options  With a lightmap.
Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::inline detail
