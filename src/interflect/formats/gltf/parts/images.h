#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "interflect/formats/gltf/data/buffers.h"
#include "interflect/image/codecs/stored_image.h"

namespace interflect::detail {

/// Opaque fraction of a surface, from the alpha channel of an image.
struct GltfCoverage {
    std::uint32_t image = none;
    float factor = 1;
    float cutoff = 0;  ///< Least alpha of opaque parts in a mask; 0 without a mask.

    float at(float alpha) const { return cutoff > 0 ? (factor * alpha >= cutoff ? 1.0f : 0.0f) : factor * alpha; }
};

/// Parameters of a texture that is computed from up to three images of a file.
struct GltfTexels {
    std::uint32_t colour = none;    ///< Image of colours in sRGB; white if absent.
    std::uint32_t metallic = none;  ///< Image whose blue channel is the metallic value.
    float metallic_factor = 0;      ///< Colours are scaled by 1 - metallic_factor * metallic.
    Rgb factor{1, 1, 1};            ///< Factor of the colours before they are clamped to 1.
    GltfCoverage coverage{};        ///< Blends the colour with `open`.
    Rgb open{0, 0, 0};              ///< Colour of the parts that are not opaque.

    auto key() const {
        return std::tuple(colour, metallic, metallic_factor, factor.x, factor.y, factor.z, coverage.image,
                          coverage.factor, coverage.cutoff, open.x, open.y, open.z);
    }
};

struct GltfImageMeans {
    Rgb colour{1, 1, 1};  ///< Mean of the linear values.
    Rgb stored{1, 1, 1};  ///< Mean of the values as stored, which may be in sRGB.
    float alpha = 1;
    float min_alpha = 1;
};

/// Images of a file, which are PNG or JPEG.
class GltfImages {
  public:
    GltfImages(GltfAsset& asset, GltfBuffers& buffers);

    /// Returns the first image with the same source; `none`, with a warning, if the image is missing.
    std::uint32_t image_of_texture(std::uint32_t texture);
    std::size_t texture_count() const { return textures_.size(); }
    bool repeats(std::uint32_t texture) const;

    /// Returns an index into Model::textures, and whether a texel was clamped.
    std::pair<std::uint32_t, bool> texture(const GltfTexels& texels);
    /// Limits the size of textures. Call this after all textures of a material, which keeps their sizes equal.
    void limit_textures();
    const GltfImageMeans& means(std::uint32_t image);

  private:
    StoredImage decode(std::uint32_t image);
    std::string bytes_of(std::uint32_t image);
    Texture make_texture(const GltfTexels& texels, bool& is_reduced);

    GltfAsset& asset_;
    GltfBuffers& buffers_;
    std::vector<GltfValue> images_, textures_, samplers_;
    std::vector<std::uint32_t> first_alike_;  // first image with the same source as each image
    std::map<decltype(GltfTexels().key()), std::pair<std::uint32_t, bool>> index_;
    std::map<std::uint32_t, GltfImageMeans> means_;
    std::uint64_t texels_ = 0, decoded_ = 0;  // number of texels, and of decoded pixels
};

}  // namespace interflect::detail
