#include "interflect/exports/gltf/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "interflect/base/files/escapes.h"
#include "interflect/core.h"
#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail {

namespace {

// Constants of glTF 2.0.
constexpr int float_type = 5126, uint32_type = 5125;
constexpr int vertex_target = 34962, index_target = 34963;
constexpr int linear_filter = 9729, mipmapped_filter = 9987, clamp_to_edge = 33071, repeat = 10497;
constexpr std::uint32_t glb_magic = 0x46546c67, glb_version = 2, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

template <class T>
std::string_view bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

std::string base64(std::string_view bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

void append_number(std::string& bytes, std::size_t number) {
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(number >> shift & 0xff);
}

void pad(std::string& bytes, char filler) { bytes.resize((bytes.size() + 3) / 4 * 4, filler); }

}  // namespace

GltfDocument::GltfDocument() { json["asset"] = {{"version", "2.0"}, {"generator", "Interflect " INTERFLECT_VERSION}}; }

int GltfDocument::add(const char* array, Json object) {
    json[array].push_back(std::move(object));
    return static_cast<int>(json[array].size()) - 1;
}

void GltfDocument::use_extension(const char* name) {
    Json& used = json["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

int GltfDocument::add_buffer_view(std::string_view bytes) {
    pad(buffer_, '\0');
    const std::size_t offset = buffer_.size();
    buffer_ += bytes;
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

int GltfDocument::add_accessor(const char* type, int component_type, std::size_t count, std::string_view bytes,
                               int target) {
    const int view = add_buffer_view(bytes);
    json["bufferViews"][view]["target"] = target;
    return add("accessors",
               {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
}

int GltfDocument::add_elements(Json accessor, std::string_view bytes, std::size_t stride) {
    const int view = add_buffer_view(bytes);
    json["bufferViews"][view]["byteStride"] = stride;
    json["bufferViews"][view]["target"] = vertex_target;
    accessor["bufferView"] = view;
    return add("accessors", std::move(accessor));
}

int GltfDocument::add_positions(std::span<const V3f> values) {
    V3f low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const V3f& value : values)
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], value[k]);
            high[k] = std::max(high[k], value[k]);
        }
    const int accessor = add_accessor("VEC3", float_type, values.size(), bytes_of(values), vertex_target);
    json["accessors"][accessor]["min"] = {low.x, low.y, low.z};
    json["accessors"][accessor]["max"] = {high.x, high.y, high.z};
    return accessor;
}

int GltfDocument::add_attribute(std::span<const Rgb> values) {
    return add_accessor("VEC3", float_type, values.size(), bytes_of(values), vertex_target);
}

int GltfDocument::add_attribute(std::span<const V2f> values) {
    return add_accessor("VEC2", float_type, values.size(), bytes_of(values), vertex_target);
}

int GltfDocument::add_indices(std::span<const std::uint32_t> values) {
    return add_accessor("SCALAR", uint32_type, values.size(), bytes_of(values), index_target);
}

int GltfDocument::add_texture(const Image& image, const std::string& name, bool repeats,
                              std::span<const float> opacity) {
    const int view = add_buffer_view(codecs::encode_png(image, opacity));
    const int source = add("images", {{"name", escaped(name)}, {"mimeType", "image/png"}, {"bufferView", view}});
    const int wrap = repeats ? repeat : clamp_to_edge;
    // Lightmaps have no mipmaps, which would mix the texels of neighbouring charts.
    const int sampler = add("samplers", {{"magFilter", linear_filter},
                                         {"minFilter", repeats ? mipmapped_filter : linear_filter},
                                         {"wrapS", wrap},
                                         {"wrapT", wrap}});
    return add("textures", {{"name", escaped(name)}, {"sampler", sampler}, {"source", source}});
}

Json GltfDocument::complete(bool with_data) const {
    Json result = json;
    if (buffer_.empty()) return result;
    Json& buffer = result["buffers"][0];
    buffer["byteLength"] = buffer_.size();
    if (with_data) buffer["uri"] = "data:application/octet-stream;base64," + base64(buffer_);
    return result;
}

std::string GltfDocument::gltf() const { return complete(true).dump(1) + "\n"; }

std::string GltfDocument::glb() const {
    std::string text = complete(false).dump(), binary = buffer_;
    pad(text, ' ');
    pad(binary, '\0');
    constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
    const std::size_t size = header_bytes + chunk_header_bytes + text.size() + chunk_header_bytes + binary.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
        throw InputError(
            fmt::format("a GLB file of {} bytes, expected less than 4 GiB: solve with fewer elements", size));
    std::string file;
    file.reserve(size);
    for (const std::size_t number :
         {std::size_t{glb_magic}, std::size_t{glb_version}, size, text.size(), std::size_t{json_chunk}})
        append_number(file, number);
    file += text;
    append_number(file, binary.size());
    append_number(file, binary_chunk);
    return file + binary;
}

}  // namespace interflect::detail
