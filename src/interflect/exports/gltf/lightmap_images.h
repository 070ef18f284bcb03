#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/lightmap/bake.h"

namespace interflect::detail {

/// Encoding of the images in a file. A linear texel of 1 represents `scale`, in the unit of `content`.
struct LightmapEncoding {
    LightmapContent content;
    float exposure;
    float scale = 1;

    float intensity() const { return scale * std::exp2(exposure); }
};

/// The images of a lightmap in a file and beside it.
struct LightmapImages {
    LightmapEncoding encoding;
    std::vector<int> textures;        ///< In the document, one per image.
    std::vector<ExportedFile> files;  ///< Unclamped images, also of light groups.
};

/// Adds the images to the document, clamped to the display's range, describes them in `asset.extras.interflect`, and
/// encodes the unclamped ones.
/// @param path  Of the document. @param groups  Names of the solution's light groups.
LightmapImages add_lightmap_images(GltfDocument& document, const std::filesystem::path& path, const BakedImages& baked,
                                   const std::vector<std::string>& groups, const ExportOptions& options);

}  // namespace interflect::detail
