#pragma once

#include <vector>

#include "interflect/export.h"
#include "interflect/exports/charts/charts.h"
#include "interflect/exports/lightmap/bake.h"

namespace interflect::detail {

struct Lightmap : BakedImages {
    std::vector<LightmapChart> charts;
    std::vector<std::uint32_t> chart_of_patch;  ///< Chart of each patch; `none` if it is hidden.
    std::vector<std::uint32_t> index_in_chart;  ///< Index of each patch in LightmapChart::patches.

    /// Returns the coordinate of a point in its image; (0, 0) is the upper left corner.
    V2f coordinate(PatchIndex patch, Parameters at) const;
    /// Returns the index of the patch's image. @param patch  Must not be hidden, as in coordinate().
    int page(PatchIndex patch) const { return charts[chart_of_patch[patch]].page; }
};

/// Makes charts of the shown patches (shown_patches()) and bakes them. @param options  Must include a lightmap.
Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
