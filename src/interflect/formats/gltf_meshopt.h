#pragma once

#include <string>
#include <string_view>

#include "interflect/formats/gltf_asset.h"

namespace interflect::detail {

/// EXT_meshopt_compression. Counts memory with take_bytes() first.
/// @throws GltfFault for damaged data or an invalid extension.
std::string decode_meshopt(const GltfValue& extension, std::string_view compressed, GltfAsset& asset);

}  // namespace interflect::detail
