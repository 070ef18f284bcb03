#include "interflect/formats/mesh/obj/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

#include "interflect/core.h"
#include "interflect/formats/build/material_limits.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/build/texture_limit.h"
#include "interflect/formats/reading/read_fault.h"
#include "interflect/formats/text/extension.h"
#include "interflect/formats/text/line_reader.h"
#include "interflect/formats/text/number.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/scene/core/limits.h"
#include "interflect/scene/faces/texel_centre.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

float mtl_number(std::string_view word) {
    const auto value = parse_number(word);
    if (!value) throw std::invalid_argument(fmt::format("expected a finite number, not '{}'", word));
    return static_cast<float>(*value);
}

/// Reads a colour. @param words  The key, then one grey value or the red, green and blue ones.
Rgb mtl_colour(std::span<const std::string_view> words) {
    if (words.size() != 2 && words.size() != 4)
        throw std::invalid_argument(
            fmt::format("{}: expected one number or three, found {} (spectral and xyz values are not read)", words[0],
                        words.size() - 1));
    Rgb result;
    const bool is_grey = words.size() == 2;
    for (int c = 0; c < 3; ++c) result[c] = mtl_number(words[is_grey ? 1 : 1 + c]);
    if (std::min({result.x, result.y, result.z}) < 0)
        throw std::invalid_argument(fmt::format("{} is negative", words[0]));
    return result;
}

constexpr std::string_view colours_key = "map_Kd", mask_key = "map_d";

constexpr int alpha = 3;  // channel of StoredImage

bool has_transparency(const StoredImage& image) {
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        if (image.value(i, alpha) < 1) return true;
    return false;
}

/// Returns the opacity of a pixel of a mask. A mask contains no colours, so its stored values are not decoded from
/// sRGB.
/// @param uses_alpha  Whether the alpha channel is the opacity, else the mean of red, green and blue.
float mask_opacity(const StoredImage& mask, bool uses_alpha, std::size_t pixel) {
    if (uses_alpha) return mask.value(pixel, alpha);
    return (mask.value(pixel, 0) + mask.value(pixel, 1) + mask.value(pixel, 2)) / 3;
}

/// Returns the maximum number of arguments of a texture option.
std::size_t max_arguments(std::string_view option) {
    if (option == "-mm") return 2;                                     // base and gain
    if (option == "-o" || option == "-s" || option == "-t") return 3;  // u, v and w
    return 1;
}

/// Returns the number of words of an option and its arguments. At least one word remains for the file name.
/// @param words  The option and all words after it.
std::size_t option_length(std::span<const std::string_view> words) {
    const std::size_t max_length = std::min(1 + max_arguments(words[0]), words.size() - 1);
    // A single argument may be any word; several are optional numbers.
    const bool is_single = max_arguments(words[0]) == 1;
    std::size_t length = 1;
    while (length < max_length && (is_single || parse_number(words[length]))) ++length;
    return length;
}

/// Returns whether a filter (Tf) is 0 or 1 in all channels. Exporters write these values for opaque materials.
bool is_neutral(std::span<const std::string_view> filter) {
    const auto are_all = [&](double value) {
        return std::all_of(filter.begin(), filter.end(), [&](auto word) { return parse_number(word) == value; });
    };
    return are_all(0) || are_all(1);
}

}  // namespace

ObjMaterials::ObjMaterials(Model& model, const ReadOptions& options) : model_(model), options_(options) {
    model_.materials.push_back(default_material());
}

void ObjMaterials::read_library(const fs::path& path, const Location& reference) {
    if (!read_paths_.insert(path.string()).second) return;
    if (options_.max_include_depth < 1)
        throw std::invalid_argument("no other file may be read (max_include_depth is 0)");
    const fs::path scene_folder = model_.file.parent_path();
    require_within(path, scene_folder, options_, fmt::format("'{}'", path.string()));
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        warn("missing-file", fmt::format("the material library '{}' does not exist", path.filename().string()),
             reference);
        return;
    }
    read_definitions(read_text_file(path), path);
}

void ObjMaterials::read_definitions(std::string_view text, const fs::path& path) {
    library_paths_.push_back(path);
    model_.files.push_back(path.string());
    Definition* current = nullptr;
    for (LineReader lines(text); lines.next();) {
        const auto words = lines.words();
        const Location location{&library_paths_.back(), lines.line(), /*part=*/{}, /*forbids_quotes=*/true};
        if (words[0] == "newmtl") {
            current = &start_definition(std::string(lines.rest()), location);
        } else if (current && !words[0].starts_with('#')) {
            try {
                read_line(words, *current, location);
            } catch (const std::invalid_argument& fault) {
                throw location.error(fault);
            }
        }
    }
}

/// Starts a definition, which replaces an earlier one of the same name.
ObjMaterials::Definition& ObjMaterials::start_definition(const std::string& name, const Location& location) {
    if (name.size() > options_.max_name_length) throw location.error("the name of this material is too long");
    Definition& definition = definitions_[name];
    definition = Definition();
    definition.location = location;
    if (const std::string short_name(name_before_comment(name)); short_name != name) {
        const auto entry = commented_definitions_.try_emplace(short_name, &definition).first;
        if (entry->second != &definition) entry->second = nullptr;  // several definitions have this short name
    }
    return definition;
}

void ObjMaterials::read_line(std::span<const std::string_view> words, Definition& definition,
                             const Location& location) {
    const std::span<const std::string_view> key_and_values = words_before_comment(words);
    const std::string_view key = words[0];
    if (key == "Kd") definition.diffuse = mtl_colour(key_and_values);
    if (key == "Ke") definition.emitted = mtl_colour(key_and_values);
    if (key == "Ks") definition.specular = mtl_colour(key_and_values);
    // File names may contain words that start with '#'
    if (key == colours_key && words.size() > 1) definition.colour_file = texture_path(words.subspan(1), location);
    if (key == mask_key && words.size() > 1) definition.mask_file = texture_path(words.subspan(1), location);
    definition.has_emission_image |= key == "map_Ke";
    definition.has_specular_image |= key == "map_Ks";
    definition.has_transparency_image |= key == "map_Tr";
    if (key == "Tf") definition.has_filter = !is_neutral(key_and_values.subspan(1));
    if ((key == "d" || key == "Tr") && key_and_values.size() > 1) read_opacity(key_and_values, definition);
}

void ObjMaterials::read_opacity(std::span<const std::string_view> words, Definition& definition) {
    const std::string_view key = words[0];
    const float value = mtl_number(words.back());  // options precede the number, as in d -halo 0.5
    if (!(value >= 0 && value <= 1)) throw std::invalid_argument(fmt::format("{} is {}; expected 0 to 1", key, value));
    if (key == "d") {
        definition.opacity = value;
        definition.has_dissolve = true;
    } else if (!definition.has_dissolve) {
        definition.opacity = 1 - value;
    }
}

fs::path ObjMaterials::texture_path(std::span<const std::string_view> words, const Location& location) {
    while (words.size() > 1 && words[0].starts_with('-')) {
        warn("texture-option", fmt::format("the option {} of texture maps is ignored", words[0]), location);
        words = words.subspan(option_length(words));
    }
    std::string name = fmt::format("{}", fmt::join(words, " "));
    std::replace(name.begin(), name.end(), '\\', '/');  // names written on Windows
    const fs::path folder = location.file->parent_path();
    std::error_code ignored;
    if (!fs::exists(folder / name, ignored)) name = std::string(name_before_comment(name));
    fs::path path = folder / name;
    try {
        require_within(path, model_.file.parent_path(), options_, fmt::format("the texture '{}'", name));
    } catch (const ReadFault& fault) {
        // Location::error() would hide quoted names (forbids_quotes). But users must know which texture to move.
        throw InputError(
            Fault{.text = fault.what(), .setting = fault.setting, .file = *location.file, .line = location.line});
    }
    return path;
}

std::uint32_t ObjMaterials::index_of(const std::string& name, const Location& reference) {
    // Search the whole text first, because names such as "Material #25" are more frequent than comments
    std::string defined_name = name;
    Definition* definition = find_definition(defined_name);
    if (!definition) {
        defined_name = name_before_comment(name);
        definition = find_definition(defined_name);
    }
    if (!definition) {
        const bool is_ambiguous = commented_definitions_.contains(defined_name);
        warn("missing-material",
             fmt::format("a material that {} is replaced by a grey of reflectance 0.5",
                         is_ambiguous ? "several definitions match" : "no library defines"),
             reference);
        return 0;
    }
    if (definition->material_index == none) definition->material_index = add_material(defined_name, *definition);
    return definition->material_index;
}

ObjMaterials::Definition* ObjMaterials::find_definition(const std::string& name) {
    if (const auto exact = definitions_.find(name); exact != definitions_.end()) return &exact->second;
    const auto commented = commented_definitions_.find(name);
    return commented == commented_definitions_.end() ? nullptr : commented->second;
}

std::uint32_t ObjMaterials::add_material(const std::string& name, const Definition& definition) {
    Material material;
    material.name = name;
    material.exitance = definition.emitted * static_cast<float>(std::numbers::pi);
    material.reflectance = definition.diffuse;
    const bool has_mask = !definition.mask_file.empty() && accept_texture(definition.mask_file, mask_key, definition);
    bool is_reduced = false;
    if (has_mask) {
        is_reduced = add_masked_textures(definition, material);
    } else {
        material.exitance *= definition.opacity;
        material.reflectance *= definition.opacity;
        material.transmittance = Rgb(1 - definition.opacity);
        material.reflectance_texture = colour_texture_index(definition);
    }
    limit_texels(definition.location);
    is_reduced |= limit_material(material, has_mask);
    if (is_reduced)
        warn("reflectance-clamped",
             fmt::format("a reflectance (Kd, map_Kd) above {}, or transmittance (d, Tr) above the rest, is reduced",
                         largest_reflectance),
             definition.location);
    // The fault begins with "exitance"
    if (const std::string fault = exitance_fault(material.exitance); !fault.empty())
        throw InputError(*definition.location.file, definition.location.line,
                         fmt::format("material '{}': the {}", name, fault));
    warn_of_omitted_keys(definition);
    model_.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(model_.materials.size() - 1);
}

bool ObjMaterials::limit_material(Material& material, bool has_mask) const {
    const std::uint32_t texture = material.reflectance_texture;
    bool is_reduced = texture == none
                          ? limit_reflectance(material.reflectance)
                          : limit_textured_reflectance(material.reflectance, largest_texel(model_.textures[texture]));
    // In each texel of add_masked_textures(), the sum of reflectance and transmittance is at most 1 already.
    if (!has_mask) is_reduced |= limit_sum(material);
    return is_reduced;
}

void ObjMaterials::warn_of_omitted_keys(const Definition& definition) {
    if (largest_channel(definition.specular) > 0 || definition.has_specular_image)
        warn("specular-reflection", "specular reflectance (Ks, map_Ks) is left out", definition.location);
    if (definition.has_emission_image)
        warn("emission-texture", "the image of emitted light (map_Ke) is left out: Ke is emitted evenly",
             definition.location);
    if (definition.has_transparency_image)
        warn("transmission-texture", "the image of transparency (map_Tr) is left out", definition.location);
    if (definition.has_filter)
        warn("transmission-filter", "the filter of transmitted light (Tf) is left out", definition.location);
}

bool ObjMaterials::add_masked_textures(const Definition& definition, Material& material) {
    const StoredImage mask = read_mask(definition);
    const bool uses_alpha = has_transparency(mask);  // an opaque alpha channel contains no mask
    const bool has_colours =
        !definition.colour_file.empty() && accept_texture(definition.colour_file, colours_key, definition);
    const Texture colours = has_colours ? read_colours(definition) : Texture{"", 1, 1, {Rgb(1)}};
    const Texture of_mask_size{definition.mask_file.string(),
                               static_cast<std::uint32_t>(mask.width),
                               static_cast<std::uint32_t>(mask.height),
                               {}};
    Texture reflectance = of_mask_size, transmittance = of_mask_size, exitance = of_mask_size;
    bool is_reduced = false;
    for (std::size_t i = 0; i < mask.pixel_count(); ++i) {
        const float opacity = definition.opacity * mask_opacity(mask, uses_alpha, i);
        Rgb colour = texel_at(colours, texel_centre(of_mask_size, i));
        is_reduced |= largest_channel(colour) > 1;
        for (int c = 0; c < 3; ++c) colour[c] = std::min(colour[c], 1.0f);
        reflectance.texels.push_back(colour * opacity);
        transmittance.texels.emplace_back(1 - opacity);
        exitance.texels.emplace_back(opacity);
    }
    material.reflectance_texture = add_texture(std::move(reflectance));
    material.transmittance = Rgb(1);
    material.transmittance_texture = add_texture(std::move(transmittance));
    if (largest_channel(material.exitance) > 0) material.exitance_texture = add_texture(std::move(exitance));
    return is_reduced;
}

std::uint32_t ObjMaterials::colour_texture_index(const Definition& definition) {
    if (definition.colour_file.empty()) return none;
    const auto [entry, is_new] = colour_textures_.try_emplace(definition.colour_file.string(), none);
    if (is_new && accept_texture(definition.colour_file, colours_key, definition))
        entry->second = add_texture(read_colours(definition));
    return entry->second;
}

std::uint32_t ObjMaterials::add_texture(Texture texture) {
    texel_count_ += texture.texels.size();
    model_.textures.push_back(std::move(texture));
    return static_cast<std::uint32_t>(model_.textures.size() - 1);
}

void ObjMaterials::limit_texels(const Location& location) {
    if (texel_count_ <= max_texels) return;
    reduce_textures(model_.textures);
    texel_count_ = texel_count(model_.textures);
    warn("textures-reduced",
         fmt::format("the largest images are halved in width and height, to at most {} texels in all", max_texels),
         location);
}

Texture ObjMaterials::read_colours(const Definition& definition) {
    try {
        require_regular_file(definition.colour_file);
        Texture texture = read_texture(definition.colour_file);
        count_decoded(texture.texels.size());
        model_.files.push_back(definition.colour_file.string());
        return texture;
    } catch (const InputError& error) {  // of the file, or of count_decoded(): this texture exceeds the total
        throw definition.location.error(
            fmt::format("the texture '{}': {}", definition.colour_file.filename().string(), error.what()));
    }
}

StoredImage ObjMaterials::read_mask(const Definition& definition) {
    try {
        constexpr auto max_pixels = static_cast<std::int64_t>(max_texels);
        StoredImage mask =
            decode_stored_image(read_bytes(definition.mask_file, max_image_bytes(max_pixels)), max_pixels);
        count_decoded(mask.pixel_count());
        model_.files.push_back(definition.mask_file.string());
        return mask;
    } catch (const std::runtime_error& error) {  // of the file, the decoder or count_decoded()
        throw definition.location.error(
            fmt::format("the texture '{}': {}", definition.mask_file.filename().string(), error.what()));
    }
}

bool ObjMaterials::accept_texture(const fs::path& texture, std::string_view key, const Definition& definition) {
    const std::string extension = lower_case_extension(texture);
    const bool is_png_or_jpeg = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
    const bool has_allowed_format =
        is_png_or_jpeg || (key == colours_key && (extension == ".exr" || extension == ".hdr"));
    std::error_code ignored;
    if (has_allowed_format && fs::exists(texture, ignored)) return true;
    warn("missing-texture",
         fmt::format("a texture ({}) is left out: its file does not exist, or is not {}", key,
                     key == colours_key ? "PNG, JPEG, EXR or HDR" : "PNG or JPEG"),
         definition.location);
    return false;
}

void ObjMaterials::count_decoded(std::size_t pixels) {
    // Each material with a mask decodes its images again, so max_texels alone does not limit the work
    constexpr std::uint64_t max_decoded_pixels = 32 * max_texels;
    decoded_pixels_ += pixels;
    if (decoded_pixels_ > max_decoded_pixels)
        throw InputError(fmt::format("the images of all materials have more than {} pixels", max_decoded_pixels));
}

}  // namespace interflect::detail
