#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/lightmap/earlier_lightmap.h"
#include "interflect/exports/lightmap/texels.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Images of a lightmap.
struct BakedImages {
    std::vector<Image> images;               ///< Irradiance [lm/m^2] or radiance [cd/m^2]; 0 between charts.
    std::vector<std::vector<Image>> groups;  ///< Images of each light group, [group][image]; or empty.
    std::string layout = "{}";               ///< Description of the layout (layout_of()), as JSON.
    std::vector<ObjectDensity> densities;    ///< Result of densities_of().
    double used = 0;                         ///< Fraction of the texels of all images that are in charts and gutters.
    double covered = 0;                      ///< Fraction of the texels of all images whose centres are on patches.
};

/// Packs charts into images. Sets the positions of the charts and returns the sizes of the images.
using PackCharts = std::function<std::vector<Imath::V2i>(std::vector<LightmapChart>& charts)>;

/// Moves the places of a chart's texels to patches of the solved scene. Clears TexelPlace::is_evaluated of hidden
/// texels, which then copy the light of a neighbour. Clears the patch of texels where that scene has none. In charts
/// without any visible texel, each copies the nearest evaluated texel in space.
/// @param chart  Index of the chart.
using MoveTexels = std::function<void(std::size_t chart, std::span<TexelPlace> places)>;

/// Packs charts, then evaluates light at texel centres or, outside the patches, at the nearest point of a patch. Direct
/// light of hybrid shading is the mean over the texel. LightmapContent::density uses neither `move_texels` nor light.
/// @param charts   Receive their positions in the images.
/// @param options  Must include a lightmap.
/// @param earlier  Lightmap whose other texels are kept (LightmapOptions::update); null: all light is computed.
/// @throws InputError above LightmapOptions::max_bytes, and for an earlier lightmap of another layout; Stopped
BakedImages bake_charts(std::vector<LightmapChart>& charts, const PackCharts& pack, const MoveTexels& move_texels,
                        const Scene& scene, const Solution& solution, const ExportOptions& options,
                        const EarlierLightmap* earlier = nullptr);

}  // namespace interflect::detail
