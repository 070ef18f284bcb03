#pragma once

#include <vector>

#include "interflect/export.h"
#include "interflect/exports/charts/charts.h"
#include "interflect/exports/lightmap/bake.h"

namespace interflect::detail {

/// Images of a lightmap, and the positions of the patches in them.
struct Lightmap : BakedImages {
    std::vector<LightmapChart> charts;
    std::vector<std::uint32_t> chart_of_patch;  ///< Index of each patch's chart; `none` if the patch is hidden.
    std::vector<std::uint32_t> index_in_chart;  ///< Index of each patch in LightmapChart::patches.

    /// Returns the texture coordinate of a point in its image. (0, 0) is the upper left corner, (1, 1) the lower right
    /// one. The patch must not be hidden.
    V2f coordinate(PatchIndex patch, Parameters at) const;
    /// Returns the index of the patch's image. The patch must not be hidden.
    int page(PatchIndex patch) const { return charts[chart_of_patch[patch]].page; }
};

/// Makes charts of the shown patches (shown_patches()) and bakes them.
/// @param options  Must include a lightmap. @param earlier  As of bake_charts().
Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options,
                       const EarlierLightmap* earlier = nullptr);

}  // namespace interflect::detail
