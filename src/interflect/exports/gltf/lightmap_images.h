#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "interflect/export.h"
#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/exports/lightmap/bake.h"

namespace interflect::detail {

/// Encoding of the images in a file. Colours of density are stored unchanged. A linear texel of 1 represents `scale`,
/// in the unit of `content`.
struct LightmapEncoding {
    LightmapContent content;
    float exposure;  ///< [stops]
    float scale = 1;

    float intensity() const { return scale * std::exp2(exposure); }
};

/// The images of a lightmap in a file and beside it. Texels brighter than the encoding's scale are divided by a gain
/// between 1 and 2^stops, whose logarithm is in another image.
struct LightmapImages {
    LightmapEncoding encoding;
    float stops = 0;                  ///< Binary logarithm of the largest gain.
    std::vector<int> textures;        ///< Indices in the document, one per image.
    std::vector<int> gains;           ///< Textures of the gains, one per image; no_gain if all its texels have 1.
    std::vector<ExportedFile> files;  ///< Unclamped images, also of light groups.

    static constexpr int no_gain = -1;
};

/// Returns the value of a material's extension MOZ_lightmap. Viewers that ignore its gain show texels clamped to
/// the scale. @param set  Index of the texture coordinates.
Json moz_lightmap(const LightmapImages& images, int page, int set);

/// Adds the images to the document, describes them in `asset.extras.interflect`, and
/// encodes the unclamped ones.
/// @param path     Path of the document. @param groups  Names of the solution's light groups.
/// @param earlier  Lightmap whose encoding is kept; null: the encoding follows from the images.
LightmapImages add_lightmap_images(GltfDocument& document, const std::filesystem::path& path, const BakedImages& baked,
                                   const std::vector<std::string>& groups, const ExportOptions& options,
                                   const EarlierLightmap* earlier = nullptr);

}  // namespace interflect::detail
