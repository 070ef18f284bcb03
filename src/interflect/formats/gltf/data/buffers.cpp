#include "interflect/formats/gltf/data/buffers.h"

#include <fmt/format.h>

#include "interflect/formats/gltf/data/meshopt.h"

namespace interflect::detail {

namespace {

constexpr const char* meshopt = "EXT_meshopt_compression";

}  // namespace

GltfBuffers::GltfBuffers(GltfAsset& asset, const GltfParts& parts)
    : asset_(asset),
      parts_(parts),
      buffers_(asset.root().objects("buffers")),
      views_(asset.root().objects("bufferViews")) {}

std::string_view GltfBuffers::buffer(std::uint32_t index) {
    const GltfValue& owner = buffers_[index];
    const std::uint64_t length = owner.integer("byteLength");
    std::string_view bytes;
    if (owner.has("uri")) {
        const auto [entry, is_new] = read_.try_emplace(index);
        if (is_new) entry->second = asset_.read_uri(owner.text("uri"), owner);
        bytes = entry->second;
    } else if (index == 0 && parts_.is_binary) {
        bytes = parts_.binary;
    } else {
        owner.fail("it has no uri, and is not the first one of a GLB with a binary chunk");
    }
    if (length > bytes.size())
        owner.fail(fmt::format("byteLength is {}, but there are {} bytes", length, bytes.size()));
    return bytes.substr(0, length);
}

std::string_view GltfBuffers::range(const GltfValue& owner) {
    const std::string_view bytes = buffer(owner.required_index("buffer", buffers_.size()));
    const std::uint64_t offset = owner.integer("byteOffset", 0), length = owner.integer("byteLength");
    if (offset > bytes.size() || length > bytes.size() - offset)
        owner.fail(fmt::format("{} bytes from {} on end beyond its buffer of {}", length, offset, bytes.size()));
    return bytes.substr(offset, length);
}

const std::string& GltfBuffers::decompressed(std::uint32_t index) {
    const auto [entry, is_new] = decompressed_.try_emplace(index);
    if (is_new) {
        const GltfValue extension = views_[index].extension(meshopt);
        entry->second = decode_meshopt(extension, range(extension), asset_);
    }
    return entry->second;
}

GltfBuffers::View GltfBuffers::view(std::uint32_t index) {
    const GltfValue& owner = views_[index];
    const std::size_t stride = owner.integer("byteStride", 0);
    if (owner.extension(meshopt).exists()) return {decompressed(index), stride};
    return {range(owner), stride};
}

}  // namespace interflect::detail
