#pragma once

#include <string>
#include <string_view>

#include "interflect/formats/gltf/data/asset.h"

namespace interflect::detail {

/// Decodes a view with EXT_meshopt_compression. Calls count_bytes() first. @throws GltfFault for invalid data.
std::string decode_meshopt(const GltfValue& extension, std::string_view compressed, GltfAsset& asset);

}  // namespace interflect::detail
