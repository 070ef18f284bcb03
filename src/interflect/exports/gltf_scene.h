#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "interflect/exports/gltf_document.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// The primitives of a glTF file's meshes, by object and material of the scene.
using GltfPrimitives = std::map<std::pair<std::uint32_t, std::uint32_t>, GltfDocument::Json>;

/// Adds the nodes: below a root, which turns `up` to y and moves the scene's origin where it is in the world, each
/// object with its mesh, and each view with its camera.
void add_nodes(GltfDocument& document, const Scene& scene, const GltfPrimitives& primitives, const V3f& up);

/// Texture coordinates from the upper left corner of an image, as glTF has them.
inline V2f gltf_coordinate(const V2f& coordinate) { return {coordinate.x, 1 - coordinate.y}; }

}  // namespace interflect::inline detail
