#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/mesh/flat_patches.h"
#include "interflect/image.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// A chart: patches in a plane. The border of their rectangle passes through the centres of the outermost texels.
struct LightmapChart {
    FlatPatches patches;  ///< Coordinates along columns and rows from texel (0, 0) [m].
    Imath::V2d size;      ///< Size of the rectangle [m].
    int columns = 2, rows = 2;
    float requested_density = 0;      ///< Result of density_of() [texels/m].
    std::uint32_t object = 0;         ///< Index into Scene::objects of the solved scene.
    bool is_updated = true;           ///< Whether its light is computed (LightmapOptions::update).
    int page = 0, left = 0, top = 0;  ///< Image and position of texel (0, 0), set by pack_charts().

    /// Returns the lower resolution of both directions [texels/m].
    double density() const { return 1 / std::max(spacing().x, spacing().y); }
    Imath::V2d spacing() const { return {size.x / (columns - 1), size.y / (rows - 1)}; }  ///< [m]
    /// Returns the texture coordinate of a point of the chart [m]; (0, 0) is the upper left corner of its image.
    V2f coordinate(const Imath::V2d& at, const std::vector<Image>& images) const;
};

/// Returns whether the light of surfaces with these names is computed (LightmapOptions::update).
bool is_updated(const std::string& object, const std::string& material, const LightmapOptions& options);

/// Returns the texels per metre on a patch.
float density_of(const Scene& scene, PatchIndex patch, const LightmapOptions& options);

/// Makes charts of the `shown` patches. Objects with a layout of their own keep it (kept_layouts()). Other smooth
/// surfaces are unfolded(), and split at creases, contacts and gaps narrower than two texels.
std::vector<LightmapChart> make_charts(const Scene& scene, std::vector<bool> shown, const LightmapOptions& options,
                                       Warnings* warnings = nullptr);

}  // namespace interflect::detail
