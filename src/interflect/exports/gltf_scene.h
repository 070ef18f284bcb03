#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "interflect/exports/gltf_document.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Primitives by object of the scene.
using GltfPrimitives = std::map<std::uint32_t, std::vector<Json>>;

/// Adds a root node, which rotates `up` to +y and restores the scene's origin, with the objects and views as children.
void add_nodes(GltfDocument& document, const Scene& scene, const GltfPrimitives& primitives, const V3f& up);

/// Adds each texture once.
class GltfTextures {
  public:
    GltfTextures(GltfDocument& document, const Scene& scene) : document_(document), scene_(scene) {}

    /// Returns pbrMetallicRoughness with the reflectance and its image, if any.
    Json diffuse(const Material& material);
    /// Stores transmittance as alpha of the base colour's texture, which it adds.
    /// @param json  Material to complete. @param material  Has a texture of transmittance.
    /// @param peak  Divisor of the reflectance.
    void cut_out(Json& json, const Material& material, const Rgb& peak = Rgb(1));
    /// Returns a reference to the texture divided by `peak`.
    Json reference(std::uint32_t texture, const Rgb& peak = Rgb(1));

  private:
    GltfDocument& document_;
    const Scene& scene_;
    std::map<std::pair<std::uint32_t, bool>, int> numbers_;  // by texture and whether divided
};

/// Moves the origin to the upper left corner, as in glTF.
inline V2f gltf_coordinate(const V2f& coordinate) { return {coordinate.x, 1 - coordinate.y}; }

}  // namespace interflect::detail
