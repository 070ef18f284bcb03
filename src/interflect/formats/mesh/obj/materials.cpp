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

/// Returns the maximum number of arguments of a texture option in MTL files: base and gain, or u, v and w, or one.
std::size_t max_arguments(std::string_view option) {
    if (option == "-mm") return 2;
    return option == "-o" || option == "-s" || option == "-t" ? 3 : 1;
}

/// Returns the number of words of the first option, with its arguments. At least one word remains for the file name.
std::size_t option_length(std::span<const std::string_view> words) {
    const std::size_t max_length = std::min(1 + max_arguments(words[0]), words.size() - 1);
    // A single argument may be any word; several are optional numbers.
    const bool is_single = max_arguments(words[0]) == 1;
    std::size_t length = 1;
    while (length < max_length && (is_single || parse_number(words[length]))) ++length;
    return length;
}

/// Returns whether a filter (Tf) is 0 or 1 in all channels, as exporters write it for opaque materials.
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

void ObjMaterials::read(const fs::path& path, const Location& where) {
    if (!read_.insert(path.string()).second) return;
    if (options_.max_include_depth < 1)
        throw std::invalid_argument("no other file may be read (max_include_depth is 0)");
    const fs::path scene_folder = model_.file.parent_path();
    require_within(path, scene_folder, options_, fmt::format("'{}'", path.string()));
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        warn("missing-file", fmt::format("the material library '{}' does not exist", path.filename().string()), where);
        return;
    }
    read_text(read_text_file(path), path);
}

void ObjMaterials::read_text(std::string_view text, const fs::path& path) {
    libraries_.push_back(path);
    model_.files.push_back(path.string());
    Definition* current = nullptr;
    for (LineReader lines(text); lines.next();) {
        const auto words = lines.words();
        const Location here{&libraries_.back(), lines.line(), {}, true};
        if (words[0] == "newmtl") {
            std::string name(lines.rest());
            if (name.size() > options_.max_name_length) throw here.error("the name of this material is too long");
            current = &(definitions_[name] = Definition());
            current->where = here;
            // Find the material by its name without the comment as well, if no other has this name
            if (std::string shorter(without_comment(name)); shorter != name) {
                const auto [entry, is_new] = commented_.try_emplace(std::move(shorter), current);
                if (entry->second != current) entry->second = nullptr;
            }
        } else if (current && !words[0].starts_with('#')) {
            try {
                read_line(words, *current, here);
            } catch (const std::invalid_argument& fault) {
                throw here.error(fault);
            }
        }
    }
}

void ObjMaterials::read_line(std::span<const std::string_view> line, Definition& definition, const Location& where) {
    const std::span<const std::string_view> words = without_comment(line);
    const std::string_view key = words[0];
    if (key == "Kd") definition.diffuse = mtl_colour(words);
    if (key == "Ke") definition.emitted = mtl_colour(words);
    if (key == "Ks") definition.specular = mtl_colour(words);
    if (key == colours_key && line.size() > 1) definition.texture = texture_path(line.subspan(1), where);
    if (key == mask_key && line.size() > 1) definition.mask = texture_path(line.subspan(1), where);
    definition.has_emission_image |= key == "map_Ke";
    definition.has_specular_image |= key == "map_Ks";
    definition.has_transparency_image |= key == "map_Tr";
    if (key == "Tf") definition.has_filter = !is_neutral(words.subspan(1));
    // `d` overrides `Tr`, in any order
    if ((key == "d" || key == "Tr") && words.size() > 1) {
        const float value = mtl_number(words.back());  // options precede the number, as in d -halo 0.5
        if (!(value >= 0 && value <= 1))
            throw std::invalid_argument(fmt::format("{} is {}; expected 0 to 1", key, value));
        if (key == "d" || !definition.has_dissolve) definition.opacity = key == "d" ? value : 1 - value;
        definition.has_dissolve |= key == "d";
    }
}

/// Returns the path of a texture. Its name follows the options and may contain spaces and '#', or precede a comment.
fs::path ObjMaterials::texture_path(std::span<const std::string_view> words, const Location& where) {
    while (words.size() > 1 && words[0].starts_with('-')) {
        warn("texture-option", fmt::format("the option {} of texture maps is ignored", words[0]), where);
        words = words.subspan(option_length(words));
    }
    std::string name = fmt::format("{}", fmt::join(words, " "));
    std::replace(name.begin(), name.end(), '\\', '/');
    const fs::path folder = where.file->parent_path();
    std::error_code ignored;
    if (!fs::exists(folder / name, ignored)) name = std::string(without_comment(name));
    fs::path path = folder / name;
    try {
        require_within(path, model_.file.parent_path(), options_, fmt::format("the texture '{}'", name));
    } catch (const ReadFault& fault) {
        // Location::error() would remove the name of the texture
        throw InputError(
            Fault{.text = fault.what(), .setting = fault.setting, .file = *where.file, .line = where.line});
    }
    return path;
}

std::uint32_t ObjMaterials::find(const std::string& name, const Location& where) {
    // Search the whole text first, because names such as "Material #25" are more frequent than comments
    std::string known_name = name;
    Definition* definition = find_definition(known_name);
    if (!definition) {
        known_name = without_comment(name);
        definition = find_definition(known_name);
    }
    if (!definition) {
        warn("missing-material", "a material that no library defines is replaced by a grey of reflectance 0.5", where);
        return 0;
    }
    if (definition->material == none) definition->material = convert(known_name, *definition);
    return definition->material;
}

ObjMaterials::Definition* ObjMaterials::find_definition(const std::string& name) {
    if (const auto exact = definitions_.find(name); exact != definitions_.end()) return &exact->second;
    const auto commented = commented_.find(name);
    return commented == commented_.end() ? nullptr : commented->second;
}

std::uint32_t ObjMaterials::convert(const std::string& name, const Definition& definition) {
    // Set the reflectance, transmittance and textures
    Material result;
    result.name = name;
    result.exitance = definition.emitted * static_cast<float>(std::numbers::pi);  // Ke is radiance
    result.reflectance = definition.diffuse;
    const bool has_holes = !definition.mask.empty() && accept_texture(definition.mask, mask_key, definition);
    bool limited = false;
    if (has_holes) {
        limited = cut_out(definition, result);
    } else {
        result.reflectance *= definition.opacity;
        result.transmittance = Rgb(1 - definition.opacity);
        result.reflectance_texture = colour_texture(definition);
    }
    if (texels_ > max_texels) {
        reduce_textures(model_.textures);
        texels_ = texel_count(model_.textures);
        warn("textures-reduced",
             fmt::format("the largest images are halved in width and height, to at most {} texels in all", max_texels),
             definition.where);
    }
    // Limit reflected and transmitted light
    limited |= limit_reflectance(result.reflectance);
    if (result.reflectance_texture != none) {
        const Rgb largest = largest_texel(model_.textures[result.reflectance_texture]);
        for (int c = 0; c < 3; ++c) {
            const float limit =
                static_cast<float>(largest_reflectance) / std::max(largest[c], 1e-6f);  // black has no limit
            limited |= result.reflectance[c] > limit;
            result.reflectance[c] = std::min(result.reflectance[c], limit);
        }
    }
    limited |= !has_holes && limit_sum(result);  // each texel of cut_out() conserves energy
    if (limited)
        warn("reflectance-clamped",
             fmt::format("reflectance (Kd), or its sum with transmittance (d, Tr), above {} is reduced",
                         largest_reflectance),
             definition.where);
    if (const std::string fault = exitance_fault(result.exitance); !fault.empty())
        throw InputError(*definition.where.file, definition.where.line,
                         fmt::format("material '{}': the {}", name, fault));
    warn_of_lost_light(definition);
    model_.materials.push_back(std::move(result));
    return static_cast<std::uint32_t>(model_.materials.size() - 1);
}

void ObjMaterials::warn_of_lost_light(const Definition& definition) {
    if (largest_channel(definition.specular) > 0 || definition.has_specular_image)
        warn("specular-reflection", "specular reflectance (Ks, map_Ks) is left out", definition.where);
    if (definition.has_emission_image)
        warn("emission-texture", "the image of emitted light (map_Ke) is left out: Ke is emitted evenly",
             definition.where);
    if (definition.has_transparency_image)
        warn("transmission-texture", "the image of transparency (map_Tr) is left out", definition.where);
    if (definition.has_filter)
        warn("transmission-filter", "the filter of transmitted light (Tf) is left out", definition.where);
}

bool ObjMaterials::accept_texture(const fs::path& texture, std::string_view key, const Definition& definition) {
    std::error_code ignored;
    const std::string extension = lower_case_extension(texture);
    const bool is_png_or_jpeg = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
    const bool is_known = is_png_or_jpeg || (key == colours_key && (extension == ".exr" || extension == ".hdr"));
    if (is_known && fs::exists(texture, ignored)) return true;
    warn("missing-texture",
         fmt::format("a texture ({}) is left out: its file does not exist, or is not {}", key,
                     key == colours_key ? "PNG, JPEG, EXR or HDR" : "PNG or JPEG"),
         definition.where);
    return false;
}

Texture ObjMaterials::read_colours(const Definition& definition) {
    if (definition.texture.empty() || !accept_texture(definition.texture, colours_key, definition))
        return {"", 1, 1, {Rgb(1)}};
    try {
        require_regular_file(definition.texture);
        Texture texture = read_texture(definition.texture);
        count_decoded(texture.texels.size());
        model_.files.push_back(definition.texture.string());
        return texture;
    } catch (const InputError& unreadable) {
        throw definition.where.error(
            fmt::format("the texture '{}': {}", definition.texture.filename().string(), unreadable.what()));
    }
}

StoredImage ObjMaterials::read_mask(const Definition& definition) {
    try {
        constexpr auto max_pixels = static_cast<std::int64_t>(max_texels);
        StoredImage mask = decode_stored_image(read_bytes(definition.mask, max_image_bytes(max_pixels)), max_pixels);
        count_decoded(mask.pixel_count());
        model_.files.push_back(definition.mask.string());
        return mask;
    } catch (const std::runtime_error& unreadable) {
        throw definition.where.error(
            fmt::format("the texture '{}': {}", definition.mask.filename().string(), unreadable.what()));
    }
}

void ObjMaterials::count_decoded(std::size_t pixels) {
    // Limits the work, because each material with a mask decodes its images again
    constexpr std::uint64_t max_decoded_pixels = 32 * max_texels;
    decoded_ += pixels;
    if (decoded_ > max_decoded_pixels)
        throw InputError(fmt::format("the images of all materials have more than {} pixels", max_decoded_pixels));
}

std::uint32_t ObjMaterials::add_texture(Texture texture) {
    texels_ += texture.texels.size();
    model_.textures.push_back(std::move(texture));
    return static_cast<std::uint32_t>(model_.textures.size() - 1);
}

std::uint32_t ObjMaterials::colour_texture(const Definition& definition) {
    if (definition.texture.empty()) return none;
    const auto [entry, is_new] = colour_textures_.try_emplace(definition.texture.string(), none);
    if (is_new && accept_texture(definition.texture, colours_key, definition))
        entry->second = add_texture(read_colours(definition));
    return entry->second;
}

bool ObjMaterials::cut_out(const Definition& definition, Material& material) {
    const StoredImage mask = read_mask(definition);
    const bool has_alpha = has_transparency(mask);
    const Texture colours = read_colours(definition);
    const Texture frame{
        definition.mask.string(), static_cast<std::uint32_t>(mask.width), static_cast<std::uint32_t>(mask.height), {}};
    Texture reflectance = frame, opening = frame, coverage = frame;
    bool is_limited = false;
    for (std::size_t i = 0; i < mask.pixel_count(); ++i) {
        // A mask is no colour, so its values count as stored, not decoded from sRGB
        const float stored =
            has_alpha ? mask.value(i, alpha) : (mask.value(i, 0) + mask.value(i, 1) + mask.value(i, 2)) / 3;
        const float covered = definition.opacity * std::min(stored, 1.0f);
        Rgb colour = texel_at(colours, texel_centre(frame, i));
        is_limited |= largest_channel(colour) > 1;
        for (int c = 0; c < 3; ++c) colour[c] = std::min(colour[c], 1.0f);
        reflectance.texels.push_back(colour * covered);
        opening.texels.emplace_back(1 - covered);
        coverage.texels.emplace_back(covered);
    }
    material.reflectance_texture = add_texture(std::move(reflectance));
    material.transmittance = Rgb(1);
    material.transmittance_texture = add_texture(std::move(opening));
    if (largest_channel(material.exitance) > 0) material.exitance_texture = add_texture(std::move(coverage));
    return is_limited;
}

}  // namespace interflect::detail
