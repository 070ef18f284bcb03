#include "interflect/exports/lightmap/lightmap.h"

#include <fmt/format.h>

#include <utility>

#include "interflect/exports/charts/atlas.h"
#include "interflect/exports/mesh/shown_patches.h"

namespace interflect::detail {

namespace {

void require_positive_densities(const LightmapOptions& options) {
    for (const auto& [pattern, density] : options.densities)
        if (density == 0)
            throw InputError(
                fmt::format("lightmap: the density of '{}' is 0: only a lightmap in the scene's own glTF file can "
                            "leave surfaces out",
                            pattern));
}

}  // namespace

V2f Lightmap::coordinate(PatchIndex patch, Parameters at) const {
    const LightmapChart& chart = charts[chart_of_patch[patch]];
    return chart.coordinate(chart.patches[index_in_chart[patch]].point(at), images);
}

Lightmap make_lightmap(const Scene& scene, const Solution& solution, const ExportOptions& options,
                       const EarlierLightmap* earlier) {
    const LightmapOptions& lightmap_options = *options.lightmap;
    require_positive_densities(lightmap_options);
    std::vector<LightmapChart> charts =
        make_charts(scene, shown_patches(scene, solution), lightmap_options, options.warnings);
    const PackCharts pack = [&](std::vector<LightmapChart>& packed) {
        return pack_charts(packed, lightmap_options.gutter, lightmap_options.max_size);
    };
    // The charts contain patches of the solved scene already
    const MoveTexels keep_places = [](std::size_t, std::span<TexelPlace>) {};
    BakedImages baked = bake_charts(charts, pack, keep_places, scene, solution, options, earlier);
    const std::vector<std::uint32_t> no_indices(scene.patches.size(), none);
    Lightmap lightmap{std::move(baked), std::move(charts), no_indices, no_indices};
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
