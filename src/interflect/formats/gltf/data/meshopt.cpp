#include "interflect/formats/gltf/data/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace interflect::detail {

namespace {

void apply_filter(const GltfValue& extension, std::string& bytes, std::size_t count, std::size_t stride) {
    const std::string filter = extension.text("filter", "NONE");
    const auto require = [&](bool is_valid) {
        if (!is_valid) extension.fail(fmt::format("the filter {} cannot have byteStride {}", filter, stride));
    };
    if (filter == "OCTAHEDRAL") {
        require(stride == 4 || stride == 8);
        meshopt_decodeFilterOct(bytes.data(), count, stride);
    } else if (filter == "QUATERNION") {
        require(stride == 8);
        meshopt_decodeFilterQuat(bytes.data(), count, stride);
    } else if (filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(bytes.data(), count, stride);
    } else if (filter != "NONE") {
        extension.fail("its filter is unknown");
    }
}

}  // namespace

std::string decode_meshopt(const GltfValue& extension, std::string_view compressed, GltfAsset& asset) {
    constexpr std::uint64_t largest_stride = 256;
    const std::uint64_t count = extension.integer("count"), stride = extension.integer("byteStride");
    const std::string mode = extension.text("mode");
    const bool is_attributes = mode == "ATTRIBUTES", is_triangles = mode == "TRIANGLES";
    if (!is_attributes && !is_triangles && mode != "INDICES") extension.fail("its mode is unknown");
    if (is_attributes ? stride < 4 || stride > largest_stride || stride % 4 != 0 : stride != 2 && stride != 4)
        extension.fail(fmt::format("the mode {} cannot have byteStride {}", mode, stride));
    if (count == 0 || (is_triangles && count % 3 != 0))
        extension.fail(fmt::format("the mode {} cannot have count {}", mode, count));
    asset.count_bytes(count * stride, extension);
    std::string bytes(count * stride, '\0');
    const auto* data = reinterpret_cast<const unsigned char*>(compressed.data());
    const int fault = is_attributes ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, data, compressed.size())
                      : is_triangles
                          ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, data, compressed.size())
                          : meshopt_decodeIndexSequence(bytes.data(), count, stride, data, compressed.size());
    if (fault != 0) extension.fail("its data are damaged");
    if (is_attributes) apply_filter(extension, bytes, count, stride);
    return bytes;
}

}  // namespace interflect::detail
