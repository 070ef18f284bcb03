#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "interflect/formats/gltf_value.h"

namespace interflect::inline detail {

/// Values of one attribute, interleaved by vertex.
struct DracoAttribute {
    int components = 0;
    std::vector<float> values;
};

struct DracoMesh {
    std::uint64_t vertex_count = 0;
    std::vector<std::uint32_t> indices;      ///< Triangle vertices.
    std::vector<DracoAttribute> attributes;  ///< In the requested order.
};

/// Decodes a mesh compressed with KHR_draco_mesh_compression.
/// @param attributes  Unique identifiers of the requested attributes.
/// @param most_triangles, most_vertices  Counts in the file's accessors; larger meshes are refused before memory is
///                                       allocated.
/// @param extension  Named in errors.
/// @throws GltfFault  if the bytes are damaged.
DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint32_t>& attributes,
                       std::uint64_t most_triangles, std::uint64_t most_vertices, const GltfValue& extension);

}  // namespace interflect::inline detail
