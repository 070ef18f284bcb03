#include "interflect/formats/gltf/data/asset.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <system_error>

#include "interflect/base/files/escapes.h"
#include "interflect/core.h"
#include "interflect/formats/gltf/data/base64.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view data_scheme = "data:";

std::uint32_t word(std::string_view bytes, std::size_t offset) {
    static_assert(std::endian::native == std::endian::little);  // as in the file
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

std::optional<std::string_view> take_chunk(std::string_view& bytes, std::uint32_t type) {
    constexpr std::size_t header = 8;
    if (bytes.empty()) return std::nullopt;
    if (bytes.size() < header || word(bytes, 0) > bytes.size() - header)
        throw GltfFault("a chunk of this GLB ends beyond the end of the file");
    if (word(bytes, 4) != type) return std::nullopt;
    const std::string_view content = bytes.substr(header, word(bytes, 0));
    bytes.remove_prefix(header + content.size());
    return content;
}

int hexadecimal_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percent_decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_escape = text[i] == '%' && i + 2 < text.size() && hexadecimal_digit(text[i + 1]) >= 0 &&
                               hexadecimal_digit(text[i + 2]) >= 0;
        result += is_escape ? static_cast<char>(16 * hexadecimal_digit(text[i + 1]) + hexadecimal_digit(text[i + 2]))
                            : text[i];
        if (is_escape) i += 2;
    }
    return result;
}

bool has_scheme(std::string_view uri) {
    const auto colon = uri.find(':');
    return colon != uri.npos && uri.find_first_of("/?#") > colon;
}

std::string cut(const std::string& uri) {
    constexpr std::size_t longest = 100;
    return escaped(uri.size() > longest ? uri.substr(0, longest) + "..." : uri);
}

}  // namespace

GltfParts gltf_parts(std::string_view bytes) {
    constexpr std::string_view magic = "glTF", byte_order_mark = "\xef\xbb\xbf";
    constexpr std::size_t header = 12;
    constexpr std::uint32_t json_type = 0x4e4f534a, binary_type = 0x004e4942;
    if (!bytes.starts_with(magic)) {
        if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
        return {bytes, {}, false};
    }
    if (bytes.size() < header) throw GltfFault("this GLB is cut short");
    if (word(bytes, 4) != 2) throw GltfFault(fmt::format("GLB version {}, expected 2", word(bytes, 4)));
    const std::uint32_t length = word(bytes, 8);
    if (length < header || length > bytes.size())
        throw GltfFault(fmt::format("this GLB has {} bytes, but says {}", bytes.size(), length));
    bytes = bytes.substr(header, length - header);
    const auto json = take_chunk(bytes, json_type);
    if (!json) throw GltfFault("this GLB does not begin with a chunk of JSON");
    const auto binary = take_chunk(bytes, binary_type);
    return {*json, binary.value_or(std::string_view()), binary.has_value()};
}

GltfAsset::GltfAsset(const fs::path& path, const ReadOptions& options, const nlohmann::json& json)
    : root_(&json, ""), options_(options) {
    model.file = path;
    model.files.push_back(path.string());
}

void GltfAsset::warn(const char* kind, const std::string& message, const std::string& place) {
    model.warnings.add(kind, message, path().string() + ": " + place);
}

void GltfAsset::count_bytes(std::uint64_t count, const GltfValue& owner) {
    if (count > options_.max_model_bytes - counted_bytes_)
        owner.fail(fmt::format("with its {} bytes, this file asks for more than {} (max_model_bytes)", count,
                               options_.max_model_bytes));
    counted_bytes_ += count;
}

std::string GltfAsset::read_uri(const std::string& uri, const GltfValue& owner) {
    constexpr std::string_view base64 = ";base64";
    if (!uri.starts_with(data_scheme)) return read_file(uri, owner);
    const auto comma = uri.find(',');
    if (comma == uri.npos) owner.fail("its data URI has no comma");
    count_bytes(uri.size(), owner);
    const std::string_view content = std::string_view(uri).substr(comma + 1);
    if (!std::string_view(uri).substr(0, comma).ends_with(base64)) return percent_decoded(content);
    auto bytes = decode_base64(content);
    if (!bytes) owner.fail("its data URI is no valid base64");
    return std::move(*bytes);
}

bool GltfAsset::is_missing(const std::string& uri, const GltfValue& owner) const {
    if (uri.starts_with(data_scheme)) return false;
    std::error_code unknown;
    return !fs::exists(file_of(uri, owner), unknown) && !unknown;
}

fs::path GltfAsset::file_of(const std::string& uri, const GltfValue& owner) const {
    if (has_scheme(uri)) owner.fail(fmt::format("'{}' is not the name of a file beside this one", cut(uri)));
    if (options_.max_include_depth < 1) owner.fail("no other file may be read (max_include_depth is 0)");
    const std::string name = percent_decoded(uri);
    const fs::path folder = path().parent_path().empty() ? fs::path(".") : path().parent_path();
    if (name.empty() || name.find('\0') != name.npos) owner.fail(fmt::format("'{}' names no file", cut(uri)));
    fs::path file = folder / name;
    const bool stays = !fs::path(name).is_absolute() && is_within(file, folder);
    if (!stays && !options_.outside_files)
        owner.fail(
            fmt::format("'{}' lies outside the folder of the scene, which is not allowed (outside_files)", cut(uri)),
            "outside_files");
    return file;
}

std::string GltfAsset::read_file(const std::string& uri, const GltfValue& owner) {
    const fs::path file = file_of(uri, owner);
    try {
        std::string bytes = read_bytes(file, options_.max_model_bytes - counted_bytes_);
        count_bytes(bytes.size(), owner);
        if (std::find(model.files.begin(), model.files.end(), file.string()) == model.files.end())
            model.files.push_back(file.string());
        return bytes;
    } catch (const InputError& unreadable) {
        owner.fail(unreadable.what());
    }
}

}  // namespace interflect::detail
