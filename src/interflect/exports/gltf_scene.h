#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "interflect/exports/gltf_document.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// The primitives of glTF meshes, by object of the scene.
using GltfPrimitives = std::map<std::uint32_t, std::vector<Json>>;

/// Adds the nodes: below a root, which turns `up` to y and moves the scene's origin where it is in the world, each
/// object with its mesh, and each view with its camera.
void add_nodes(GltfDocument& document, const Scene& scene, const GltfPrimitives& primitives, const V3f& up);

/// Adds a scene's textures, each once.
class GltfTextures {
  public:
    GltfTextures(GltfDocument& document, const Scene& scene) : document_(document), scene_(scene) {}

    /// Diffuse reflection as pbrMetallicRoughness, with the image of the reflectance where there is one.
    Json diffuse(const Material& material);
    /// Gives a material holes, by the alpha of its base colour's texture, which it then has in any case.
    /// @param json  What has been made of the material. @param material  It has a texture of transmittance.
    /// @param peak  What the reflectance is divided by.
    void cut_out(Json& json, const Material& material, const Rgb& peak = Rgb(1));
    /// A reference to a texture of the scene, divided by `peak`.
    Json reference(std::uint32_t texture, const Rgb& peak = Rgb(1));

  private:
    GltfDocument& document_;
    const Scene& scene_;
    std::map<std::pair<std::uint32_t, bool>, int> numbers_;  // by texture, and whether it was divided
};

/// Texture coordinates from the upper left corner of an image, as glTF has them.
inline V2f gltf_coordinate(const V2f& coordinate) { return {coordinate.x, 1 - coordinate.y}; }

}  // namespace interflect::inline detail
