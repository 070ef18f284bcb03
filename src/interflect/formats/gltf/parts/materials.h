#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "interflect/formats/gltf/parts/images.h"

namespace interflect::detail {

/// Affine map of texture coordinates (KHR_texture_transform).
struct GltfMapping {
    std::uint64_t set = 0;  ///< Number in the name TEXCOORD_set.
    double xx = 1, xy = 0, x = 0, yx = 0, yy = 1, y = 0;

    bool operator==(const GltfMapping&) const = default;
    /// Returns coordinates as in Scene, where v points upwards.
    V2f apply(double u, double v) const {
        return {static_cast<float>(xx * u + xy * v + x), static_cast<float>(1 - (yx * u + yy * v + y))};
    }
};

/// A material of the model, and the properties of its faces.
struct GltfSurface {
    std::uint32_t material = 0;
    std::optional<GltfMapping> mapping;  ///< Mapping that all textures share.
    bool repeats = true;                 ///< Whether textures repeat beyond coordinates from 0 to 1.
    bool double_sided = false;
    bool is_invisible = false;
};

struct GltfTextureUse {
    std::uint32_t image = none;
    GltfMapping mapping;
    bool repeats = true;
};

class GltfMaterials {
  public:
    GltfMaterials(GltfAsset& asset, GltfImages& images);

    std::size_t count() const { return materials_.size(); }
    /// @param index  Index in the file; `none` for the default material.
    /// @param textured  Whether to use textures; otherwise, their means are used.
    const GltfSurface& surface(std::uint32_t index, bool textured);

    /// Returns the material with its diffuse reflectance multiplied by `tint`.
    /// @param material  Index into Model::materials.
    std::uint32_t tinted(std::uint32_t material, const Rgb& tint);

    /// Warns about specular reflection, which is omitted. Call this after the last surface().
    void warn_of_lost_reflection();

  private:
    struct Parts;

    GltfSurface make(std::uint32_t index, bool textured);
    GltfSurface make_default();
    Parts parts_of(const GltfValue& owner);
    GltfTextureUse use_of(const GltfValue& owner, const char* key);
    void warn_of_ignored(const GltfValue& owner);
    void apply_alpha(const GltfValue& owner, Parts& parts, GltfSurface& surface);
    /// Chooses the mapping of all textures. Replaces textures with other mappings by their means.
    void choose_mapping(const GltfValue& owner, Parts& parts, bool textured);
    /// Set the reflectance and the transmittance.
    void reflect(const GltfValue& owner, const Parts& parts, Material& material);
    void transmit(const GltfValue& owner, const Parts& parts, Material& material);

    GltfAsset& asset_;
    GltfImages& images_;
    std::vector<GltfValue> materials_;
    std::map<std::pair<std::uint32_t, bool>, GltfSurface> surfaces_;
    std::map<std::tuple<std::uint32_t, float, float, float>, std::uint32_t> tinted_;
    double lost_ = 0, all_ = 0;        // omitted and total reflectance, summed over materials and channels
    std::vector<std::string> losing_;  // places of materials whose reflection is omitted
};

}  // namespace interflect::detail
