#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/charts/charts.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Lightmap of the file that an export updates (LightmapOptions::update).
struct EarlierLightmap {
    std::filesystem::path path;              ///< Path of the glTF file.
    Json layout;                             ///< Description of its layout (layout_of()).
    float exposure, scale, stops;            ///< As in LightmapImages.
    double covered;                          ///< BakedImages::covered
    std::vector<Image> images;               ///< Unclamped images.
    std::vector<std::vector<Image>> groups;  ///< Unclamped images of each light group, [group][image].
};

/// Returns the name of the quantity of images in files.
const char* quantity_of(LightmapContent content);

/// Describes a layout: the options that determine it, and a checksum of the charts' places.
/// @param charts  Packed charts. @param scene  The solved scene.
Json layout_of(std::span<const LightmapChart> charts, const Scene& scene, const LightmapOptions& options);

/// Reads the lightmap of a glTF file and of the images beside it.
/// @param groups  Names of the solution's light groups.
/// @throws InputError if the file or an image is missing or unreadable, or if it has another content or other groups.
EarlierLightmap read_earlier_lightmap(const std::filesystem::path& path, const LightmapOptions& options,
                                      const std::vector<std::string>& groups);

/// @param sizes  Sizes of the images. @throws InputError that names the differences to the earlier layout.
void require_same_layout(const EarlierLightmap& earlier, const Json& layout, std::span<const Imath::V2i> sizes);

}  // namespace interflect::detail
