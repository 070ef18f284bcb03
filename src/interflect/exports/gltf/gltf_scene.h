#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "interflect/exports/gltf/gltf_document.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// JSON of the primitives of each object.
using GltfPrimitives = std::map<std::uint32_t, std::vector<Json>>;

/// Adds objects and views to a root node. The root rotates `up` to +y and translates by Scene::origin.
void add_nodes(GltfDocument& document, const Scene& scene, const GltfPrimitives& primitives, const V3f& up);

/// Adds the textures of materials to a document.
class GltfTextures {
  public:
    GltfTextures(GltfDocument& document, const Scene& scene) : document_(document), scene_(scene) {}

    /// Returns the JSON object pbrMetallicRoughness of a diffuse material.
    Json diffuse(const Material& material);
    /// Adds the reflectance and opacity of a material with a transmittance texture.
    /// @param peak  Divisor of the reflectance.
    void cut_out(Json& json, const Material& material, const Rgb& peak = Rgb(1));
    /// Returns a reference to a texture divided by `peak`. Adds the texture on first use.
    Json reference(std::uint32_t texture, const Rgb& peak = Rgb(1));

  private:
    GltfDocument& document_;
    const Scene& scene_;
    std::map<std::pair<std::uint32_t, bool>, int> numbers_;  // keys: texture, and whether it is divided by `peak`
};

/// Converts a texture coordinate to glTF, where the origin is the upper left corner of the image.
inline V2f gltf_coordinate(const V2f& coordinate) { return {coordinate.x, 1 - coordinate.y}; }

}  // namespace interflect::detail
