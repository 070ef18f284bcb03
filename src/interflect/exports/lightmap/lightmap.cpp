#include "interflect/exports/lightmap/lightmap.h"

#include <fmt/format.h>

#include "interflect/exports/charts/atlas.h"
#include "interflect/exports/mesh/shown_patches.h"

namespace interflect::detail {

V2f Lightmap::coordinate(PatchIndex patch, Parameters at) const {
    const LightmapChart& chart = charts[chart_of_patch[patch]];
    return chart.coordinate(chart.patches[index_in_chart[patch]].point(at), images);
}

Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options) {
    const LightmapOptions& lightmap_options = *options.lightmap;
    for (const auto& [pattern, density] : lightmap_options.densities)
        if (density == 0)
            throw InputError(
                fmt::format("lightmap: the density of '{}' is 0, which leaves surfaces out: this needs the "
                            "scene's own glTF file",
                            pattern));
    Lightmap lightmap;
    lightmap.charts = make_charts(scene, shown_patches(scene, solution), lightmap_options, options.warnings);
    const PackCharts pack = [&](std::vector<LightmapChart>& charts) {
        return pack_charts(charts, lightmap_options.gutter, lightmap_options.max_size);
    };
    // The charts are on patches of the solved scene already, so texels need no move.
    const MoveTexels stay = [](std::size_t, std::span<TexelPlace>) {};
    // Assign the images, which are the base of Lightmap.
    static_cast<BakedImages&>(lightmap) = bake_charts(lightmap.charts, pack, stay, scene, solution, options);
    lightmap.chart_of_patch.assign(scene.patches.size(), none);
    lightmap.index_in_chart.assign(scene.patches.size(), none);
    for (std::uint32_t i = 0; i < lightmap.charts.size(); ++i) {
        const FlatPatches& patches = lightmap.charts[i].patches;
        for (std::uint32_t k = 0; k < patches.size(); ++k) {
            lightmap.chart_of_patch[patches[k].patch] = i;
            lightmap.index_in_chart[patches[k].patch] = k;
        }
    }
    return lightmap;
}

}  // namespace interflect::detail
