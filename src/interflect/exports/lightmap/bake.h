#pragma once

#include <functional>
#include <span>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/lightmap/texels.h"
#include "interflect/image.h"

namespace interflect::detail {

struct BakedImages {
    std::vector<Image> images;               ///< Irradiance [lm/m^2] or radiance [cd/m^2]; 0 between charts.
    std::vector<std::vector<Image>> groups;  ///< Images of each light group, [group][image].
    double used = 0;                         ///< Share of texels in charts and gutters.
    double covered = 0;                      ///< Share of texels on patches.
};

/// Packs charts into images; returns the sizes of the images.
using PackCharts = std::function<std::vector<Imath::V2i>(std::vector<LightmapChart>& charts)>;

/// Moves the texels of a chart, given by its index, to patches of the solved scene. Hidden texels lose
/// TexelPlace::is_near; if all of a chart are hidden, they copy the nearest light in space.
using MoveTexels = std::function<void(std::size_t chart, std::span<TexelPlace> places)>;

/// Packs charts, then evaluates light at texel centres or, outside the patches, at the nearest point of a patch. Direct
/// light of hybrid shading is the mean over the texel.
/// @param options  Must include a lightmap. @throws InputError beyond LightmapOptions::max_bytes; Stopped
BakedImages bake_charts(std::vector<LightmapChart>& charts, const PackCharts& pack, const MoveTexels& move,
                        const Scene& scene, const Solution& solution, const ExportOptions& options);

}  // namespace interflect::detail
