#pragma once

#include <string>
#include <string_view>

#include "interflect/formats/gltf_asset.h"

namespace interflect::inline detail {

/// Decompresses a buffer view compressed with EXT_meshopt_compression.
/// @param extension  The view's extension object. @param compressed  Compressed bytes.
/// @throws GltfFault  if the bytes are damaged or the extension is invalid; GltfAsset::take_bytes() checks memory
///                    first.
std::string decode_meshopt(const GltfValue& extension, std::string_view compressed, GltfAsset& asset);

}  // namespace interflect::inline detail
