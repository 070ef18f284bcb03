#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "interflect/formats/gltf_buffers.h"
#include "interflect/image/stored_image.h"

namespace interflect::inline detail {

/// How much of a surface is there, 0 to 1 from point to point; the rest is open.
struct GltfCoverage {
    std::uint32_t image = none;  ///< Whose alpha it is; none: all of the surface is there.
    float factor = 1;            ///< Of the alpha.
    float cutoff = 0;            ///< Above 0: what has at least this is there as a whole, and nothing of the rest.

    float at(float alpha) const { return cutoff > 0 ? (factor * alpha >= cutoff ? 1.0f : 0.0f) : factor * alpha; }
};

/// What a texture of the model is made of; equal ones are one texture.
struct GltfTexels {
    std::uint32_t colour = none;    ///< Image of sRGB colours; none: white.
    std::uint32_t metallic = none;  ///< Image whose blue channel is metallic; none: `metallic_factor` alone.
    float metallic_factor = 0;      ///< Colours are multiplied by 1 - metallic.
    Rgb factor{1, 1, 1};            ///< Of the result, which is reduced to 1 where it is more.
    GltfCoverage coverage{};        ///< What is open has `open` in place of all that.
    Rgb open{0, 0, 0};

    auto key() const {
        return std::tuple(colour, metallic, metallic_factor, factor.x, factor.y, factor.z, coverage.image,
                          coverage.factor, coverage.cutoff, open.x, open.y, open.z);
    }
};

/// Means over all pixels of an image.
struct GltfImageMeans {
    Rgb colour{1, 1, 1};  ///< Decoded from sRGB.
    Rgb stored{1, 1, 1};  ///< As it is.
    float alpha = 1;
    float least_alpha = 1;  ///< Not a mean, but the smallest.
};

/// The images of a glTF file, from buffer views, data URIs and files: PNG and JPEG.
class GltfImages {
  public:
    GltfImages(GltfAsset& asset, GltfBuffers& buffers);

    /// The image of a texture; none where it has none that can be read, with a warning.
    std::uint32_t image_of_texture(std::uint32_t texture);
    std::size_t texture_count() const { return textures_.size(); }
    /// Whether a texture repeats in both directions.
    bool repeats(std::uint32_t texture) const;

    /// @return  index into Model::textures, and whether a texel was reduced to `largest`.
    std::pair<std::uint32_t, bool> texture(const GltfTexels& texels);
    /// Reduces the textures made so far where they have too many texels, with a warning. Call it when all textures of a
    /// material are made, since they must stay of equal size.
    void limit_textures();
    const GltfImageMeans& means(std::uint32_t image);

  private:
    StoredImage decode(std::uint32_t image);
    std::string bytes_of(std::uint32_t image);
    std::uint32_t first_alike(std::uint32_t image) const;
    Texture make_texture(const GltfTexels& texels, bool& is_reduced);

    GltfAsset& asset_;
    GltfBuffers& buffers_;
    std::vector<GltfValue> images_, textures_, samplers_;
    std::vector<std::uint32_t> first_alike_;  // the first image from the same source
    std::map<decltype(GltfTexels().key()), std::pair<std::uint32_t, bool>> index_;
    std::map<std::uint32_t, GltfImageMeans> means_;
    std::uint64_t texels_ = 0, decoded_ = 0;
};

}  // namespace interflect::inline detail
