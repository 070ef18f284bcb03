#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "interflect/exports/gltf_document.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Primitives of glTF meshes, by object of the scene.
using GltfPrimitives = std::map<std::uint32_t, std::vector<Json>>;

/// Adds a root node that rotates `up` to +y and restores the scene's origin. Its children are the objects with their
/// meshes and the views with their cameras.
void add_nodes(GltfDocument& document, const Scene& scene, const GltfPrimitives& primitives, const V3f& up);

/// Adds the textures of a scene, each once.
class GltfTextures {
  public:
    GltfTextures(GltfDocument& document, const Scene& scene) : document_(document), scene_(scene) {}

    /// Returns diffuse reflection as pbrMetallicRoughness, with the image of the reflectance if it has one.
    Json diffuse(const Material& material);
    /// Adds the transmittance of a material as alpha of its base colour's texture; creates that texture if necessary.
    /// @param json  The material so far. @param material  Has a texture of transmittance.
    /// @param peak  Divisor of the reflectance.
    void cut_out(Json& json, const Material& material, const Rgb& peak = Rgb(1));
    /// Returns a reference to a texture of the scene, divided by `peak`.
    Json reference(std::uint32_t texture, const Rgb& peak = Rgb(1));

  private:
    GltfDocument& document_;
    const Scene& scene_;
    std::map<std::pair<std::uint32_t, bool>, int> numbers_;  // by texture and whether it was divided
};

/// Converts texture coordinates to glTF, whose origin is the upper left corner of an image.
inline V2f gltf_coordinate(const V2f& coordinate) { return {coordinate.x, 1 - coordinate.y}; }

}  // namespace interflect::inline detail
