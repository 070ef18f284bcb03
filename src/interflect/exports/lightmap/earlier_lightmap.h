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
    std::filesystem::path path;                 ///< Path of the glTF file.
    Json layout;                                ///< Description of its layout (layout_of()).
    float exposure, scale, stops;               ///< As in LightmapImages; finite, scale > 0, stops >= 0.
    double covered;                             ///< BakedImages::covered
    std::vector<std::filesystem::path> images;  ///< Paths of the unclamped images.
    std::vector<std::vector<std::filesystem::path>>
        groups;  ///< Paths of the images of each light group, [group][image].
};

/// Returns the name of the quantity of images in files.
const char* quantity_of(LightmapContent content);

/// Describes a layout: the options that determine it, and a checksum of the places and outlines of all patches in the
/// images. Outlines are rounded to an eighth of a texel, because moved objects have other rounding errors.
/// @param charts  Packed charts. @param scene  The solved scene.
Json layout_of(std::span<const LightmapChart> charts, const Scene& scene, const LightmapOptions& options);

/// Reads the description of the lightmap in a glTF file.
/// @param groups  Names of the solution's light groups.
/// @throws InputError if the file is missing or unreadable, or if it has another content or other groups.
EarlierLightmap read_earlier_lightmap(const std::filesystem::path& path, const LightmapOptions& options,
                                      const std::vector<std::string>& groups);

/// @throws InputError that names the differences to the earlier layout.
void require_same_layout(const EarlierLightmap& earlier, const Json& layout);

/// Reads the unclamped images of each light group or, if `groups` is empty, of all light.
/// @param images, groups  Images of the same layout, which are replaced.
/// @throws InputError if an image is missing or unreadable, or has another size.
void read_images(const EarlierLightmap& earlier, std::vector<Image>& images, std::vector<std::vector<Image>>& groups);

}  // namespace interflect::detail
