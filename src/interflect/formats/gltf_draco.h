#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "interflect/formats/gltf_value.h"

namespace interflect::inline detail {

/// The values of one attribute, those of a vertex side by side.
struct DracoAttribute {
    int components = 0;
    std::vector<float> values;
};

struct DracoMesh {
    std::uint64_t vertex_count = 0;
    std::vector<std::uint32_t> indices;      ///< Of triangles.
    std::vector<DracoAttribute> attributes;  ///< As many as were asked for, in that order.
};

/// Decodes what KHR_draco_mesh_compression compresses.
/// @param attributes        Unique identifiers of those that are wanted.
/// @param most_triangles, most_vertices  As the file's accessors tell; more are refused before memory is taken.
/// @param extension         Named in errors.
/// @throws GltfFault where the bytes are damaged.
DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint32_t>& attributes,
                       std::uint64_t most_triangles, std::uint64_t most_vertices, const GltfValue& extension);

}  // namespace interflect::inline detail
