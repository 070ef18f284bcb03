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
    const LightmapOptions& chosen = *options.lightmap;
    for (const auto& [pattern, density] : chosen.densities)
        if (density == 0)
            throw InputError(
                fmt::format("lightmap: the density of '{}' is 0: only lightmaps in the scene's own glTF file "
                            "leave surfaces out, and this file is written anew",
                            pattern));
    Lightmap lightmap;
    lightmap.charts = make_charts(scene, shown_patches(scene, solution), chosen, options.warnings);
    const PackCharts pack = [&](std::vector<LightmapChart>& charts) {
        return pack_charts(charts, chosen.gutter, chosen.max_size);
    };
    const MoveTexels stay = [](std::size_t, std::span<TexelPlace>) {};
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
