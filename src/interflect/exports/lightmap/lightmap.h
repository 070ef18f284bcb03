#pragma once

#include <vector>

#include "interflect/export.h"
#include "interflect/exports/lightmap/lightmap_charts.h"
#include "interflect/image.h"

namespace interflect::detail {

struct Lightmap {
    std::vector<LightmapChart> charts;
    std::vector<std::uint32_t> chart_of_patch;  ///< Chart of each patch; `none` if it is hidden.
    std::vector<std::uint32_t> index_in_chart;
    std::vector<Image> images;               ///< Irradiance [lm/m^2] or radiance [cd/m^2]; 0 between charts.
    std::vector<std::vector<Image>> groups;  ///< Images of each light group, [group][image].
    double used = 0;                         ///< Share of texels in charts and gutters.
    double covered = 0;                      ///< Share of texels on patches.

    /// Returns the coordinate of a point in its image; (0, 0) is the upper left corner.
    V2f coordinate(PatchIndex patch, Parameters at) const;
    int page(PatchIndex patch) const { return charts[chart_of_patch[patch]].page; }
};

/// Evaluates light at texel centres or, outside the patches, at the nearest point of a patch. Direct light of hybrid
/// shading is the mean over the texel.
/// @param options  Must include a lightmap.
Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
