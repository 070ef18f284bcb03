#include "interflect/exports/files/exported_parts.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "interflect/base/files/escapes.h"
#include "interflect/core.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/text/extension.h"
#include "interflect/image.h"
#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_plain(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }

std::string plain_name(std::string name, const char* kind) {
    for (char& c : name)
        if (!is_plain(c)) c = '_';
    if (name.empty()) name = kind;
    if (!is_letter(name.front())) name.insert(0, "_");
    return name;
}

Image image_of(const Texture& texture) {
    Image image(static_cast<int>(texture.width), static_cast<int>(texture.height));
    image.pixels = texture.texels;
    return image;
}

}  // namespace

std::vector<std::string> plain_names(const std::vector<std::string>& names, const char* kind, std::size_t most) {
    std::set<std::string> taken;
    std::map<std::string, int> next_numbers;  // next number to append, for each base name
    std::vector<std::string> plain;
    for (const std::string& name : names) {
        const std::string base = plain_name(name, kind).substr(0, most);
        std::string free = base;
        int& number = next_numbers.try_emplace(base, 2).first->second;
        for (; !taken.insert(free).second; ++number) free = fmt::format("{}_{}", base, number);
        plain.push_back(std::move(free));
    }
    return plain;
}

std::vector<std::string> material_names(const Scene& scene) {
    constexpr std::size_t most = 64;  // file systems limit names to 255 bytes
    std::vector<std::string> names;
    for (const Material& material : scene.materials) names.push_back(material.name);
    return plain_names(names, "material", most);
}

std::vector<std::string> object_names(const Scene& scene) { return plain_names(scene.objects, "scene"); }

std::filesystem::path path_beside(const std::filesystem::path& path, const std::string& name) {
    const std::string format = lower_case_extension(path).substr(1);
    return path.parent_path() / fmt::format("{}-{}-{}", path.stem().string(), format, name);
}

std::vector<ExportedFile> texture_files(const std::filesystem::path& path, const Scene& scene) {
    std::vector<ExportedFile> files;
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Texture& texture = scene.textures[i];
        const std::string extension = texture_extension(texture);
        files.push_back({path_beside(path, fmt::format("texture-{}{}", i, extension)),
                         extension == ".png" ? codecs::encode_png(image_of(texture)) : exr_bytes(texture)});
    }
    return files;
}

void require_nameable(const std::filesystem::path& path, std::string_view excluded) {
    const std::string stem = path.stem().string();
    std::string without_backslashes = stem;  // escaped() may change backslashes, which are allowed
    std::erase(without_backslashes, '\\');
    if (escaped(without_backslashes) == without_backslashes && stem.find_first_of(excluded) == stem.npos) return;
    throw InputError(path, 0,
                     fmt::format("files of this format cannot hold this name, which they need to refer to others: "
                                 "expected one without control characters{}{}, in UTF-8",
                                 excluded.empty() ? "" : " and without any of ", excluded));
}

std::string quotable(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

std::string xml_text(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

std::string exr_bytes(const Texture& texture) {
    ImageMetadata metadata;
    metadata.quantity = "texels, linear Rec. 709";
    metadata.version = INTERFLECT_VERSION;
    return codecs::encode_exr(image_of(texture), metadata, {});
}

std::string hdr_bytes(const Texture& texture) { return codecs::encode_radiance(image_of(texture)); }

}  // namespace interflect::detail
