#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "interflect/formats/gltf/data/value.h"

namespace interflect::detail {

/// Values of an attribute, ordered by vertex.
struct DracoAttribute {
    int components = 0;
    std::vector<float> values;
};

struct DracoMesh {
    std::uint64_t vertex_count = 0;
    std::vector<std::uint32_t> indices;  ///< Three vertices per triangle.
    std::vector<DracoAttribute> attributes;
};

/// @param attributes  Unique identifiers, in the order of the result.
/// @throws GltfFault for invalid data, and before any allocation if they exceed max_triangles or max_vertices.
DracoMesh decode_draco(std::string_view bytes, const std::vector<std::uint32_t>& attributes,
                       std::uint64_t max_triangles, std::uint64_t max_vertices, const GltfValue& extension);

}  // namespace interflect::detail
