#pragma once

#include <string>
#include <string_view>

#include "interflect/formats/gltf_asset.h"

namespace interflect::inline detail {

/// What a buffer view holds that is compressed by EXT_meshopt_compression.
/// @param extension  The view's extension object. @param compressed  Its bytes.
/// @throws GltfFault where they are damaged or the extension breaks its rules; GltfAsset::take_bytes() is asked first.
std::string decode_meshopt(const GltfValue& extension, std::string_view compressed, GltfAsset& asset);

}  // namespace interflect::inline detail
