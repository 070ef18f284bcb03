#pragma once

#include <string>
#include <string_view>

#include "interflect/formats/gltf_asset.h"

namespace interflect::detail {

/// Decompresses a buffer view (EXT_meshopt_compression). @param extension  The view's extension object.
/// @throws GltfFault  for damaged data or an invalid extension. GltfAsset::take_bytes() is called first.
std::string decode_meshopt(const GltfValue& extension, std::string_view compressed, GltfAsset& asset);

}  // namespace interflect::detail
