#pragma once

#include <vector>

#include "interflect/export.h"
#include "interflect/exports/lightmap_charts.h"
#include "interflect/image.h"

namespace interflect::inline detail {

/// Images of the light of a solved scene.
struct Lightmap {
    std::vector<LightmapChart> charts;
    std::vector<std::uint32_t> chart_of_patch;  ///< Chart of each patch; none if it is not shown (shown_patches).
    std::vector<std::uint32_t> index_in_chart;  ///< Index of each patch within its chart.
    std::vector<Image> images;  ///< H [lm/m^2] or L [cd/m^2], see LightmapOptions::content; 0 between the charts.
    std::vector<std::vector<Image>> groups;  ///< [group][image]: contribution of each light group, see LightmapOptions.
    double used = 0;                         ///< Fraction of texels in charts and their gutters.
    double covered = 0;                      ///< Fraction of texels on the patches of charts.

    /// Returns the coordinates of a patch point in the image of its chart, (0, 0) at the upper left.
    V2f coordinate(std::uint32_t patch, Parameters at) const;
    int page(std::uint32_t patch) const { return charts[chart_of_patch[patch]].page; }
};

/// Evaluates the light at the centre of every texel on the surface of its chart. Texels beyond the patches, as in the
/// gutters, use the nearest point of the patches.
/// @param options  Must include a lightmap.
Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::inline detail
