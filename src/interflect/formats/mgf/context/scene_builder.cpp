#include "interflect/formats/mgf/context/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interflect/core.h"
#include "interflect/formats/build/material_limits.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/mgf/context/arguments.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/scene/core/limits.h"
#include "interflect/scene/sky/environment_maps.h"

namespace interflect::detail {

namespace {

constexpr std::size_t max_lights = 1 << 16;

/// Returns a key that equal materials share.
std::string identity(const Material& m) {
    std::string key = m.name;
    const auto append = [&](const auto& value) { key.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const Rgb& c : {m.reflectance, m.exitance, m.transmittance, m.specular_reflectance}) append(c);
    for (const std::uint32_t texture : {m.reflectance_texture, m.exitance_texture, m.transmittance_texture})
        append(texture);
    return key;
}

}  // namespace

MgfSceneBuilder::MgfSceneBuilder(const std::filesystem::path& file, const ReadOptions& options,
                                 const Imath::V3d& origin)
    : faces_(scene_, options), weld_(scene_) {
    scene_.origin = origin;
    scene_.name = file.string();
    scene_.objects.emplace_back();
    object_index_.emplace("", 0);
}

void MgfSceneBuilder::warn(const std::string& kind, const std::string& message, const Location& where) {
    scene_.warnings.add(kind, where.shown(message), where.text());
}

Rgb MgfSceneBuilder::converted(const MgfColour& colour, double luminance, double largest, const Location& where) {
    const Rec709Colour result = to_rec709(colour.chromaticity, luminance, largest);
    if (result.out_of_gamut && luminance > 0)
        warn("out-of-gamut", "colour outside Rec. 709 is desaturated, its luminance is kept", where);
    if (result.too_bright) warn_of_bright_reflectance(where);
    return result.rgb;
}

void MgfSceneBuilder::warn_of_bright_reflectance(const Location& where) {
    warn("reflectance-clamped", "diffuse reflectance above 0.99, at least in one colour channel, is reduced to 0.99",
         where);
}

std::uint32_t MgfSceneBuilder::texture(const MgfTexture& texture) {
    if (texture.path.empty()) return none;
    const auto [entry, is_new] =
        texture_index_.try_emplace(texture.path, static_cast<std::uint32_t>(scene_.textures.size()));
    if (!is_new) return entry->second;
    try {
        require_regular_file(texture.path);
        scene_.textures.push_back(read_texture(texture.path));
    } catch (const InputError& unreadable) {
        throw InputError(*texture.where.file, texture.where.line, fmt::format("the texture {}", unreadable.what()));
    }
    texels_ += scene_.textures.back().texels.size();
    if (texels_ > max_texels)
        throw InputError(*texture.where.file, texture.where.line,
                         fmt::format("with this texture there are more than {} texels", max_texels));
    largest_texels_.push_back(largest_texel(scene_.textures.back()));
    add_file(texture.path);
    return entry->second;
}

void MgfSceneBuilder::require_products(const Material& result, const MgfMaterial& material) const {
    const Rgb reflectance = textured(result.reflectance, result.reflectance_texture, largest_texels_);
    if (const Location& where = material.rd_texture.where; !(largest_channel(reflectance) < 1))
        throw InputError(*where.file, where.line,
                         fmt::format("reflectance times texture is up to ({}, {}, {}); expected less than 1",
                                     reflectance.x, reflectance.y, reflectance.z));
    const std::string fault = exitance_fault(textured(result.exitance, result.exitance_texture, largest_texels_));
    if (const Location& where = material.ed_texture.where; !fault.empty())
        throw InputError(*where.file, where.line, "with the texture's largest texel, the " + fault);
    if (result.transmittance_texture == none) return;
    const Rgb sum = largest_sum(result, scene_.textures, largest_texels_);
    if (const Location& where = material.ts_texture.where; !(largest_channel(sum) <= 1))
        throw InputError(*where.file, where.line,
                         fmt::format("rd, rs and ts times their textures are up to ({}, {}, {}) in sum; expected at "
                                     "most 1",
                                     sum.x, sum.y, sum.z));
}

Rgb MgfSceneBuilder::emitted(const MgfColour& colour, double luminance, const Location& where) {
    constexpr double unbounded = std::numeric_limits<float>::max();
    return converted(colour, luminance, unbounded, where);
}

void MgfSceneBuilder::add_light(Luminaire luminaire, const std::string& name) {
    if (scene_.luminaires.size() >= max_lights)
        throw std::invalid_argument(fmt::format("this is one light more than the {} that are read", max_lights));
    luminaire.name = fmt::format("{}-{}", name, scene_.luminaires.size() + 1);
    if (const std::string fault = luminaire_fault(luminaire); !fault.empty())
        throw std::invalid_argument("this light " + fault);
    const bool is_one_of_skies = is_sky(luminaire);
    scene_.luminaires.push_back(std::move(luminaire));
    if (const std::string fault = is_one_of_skies ? sky_count_fault(scene_) : ""; !fault.empty())
        throw std::invalid_argument("with this light the scene " + fault);
}

std::uint32_t MgfSceneBuilder::material(MgfMaterial& material, std::string_view name) {
    if (material.scene_index != none) return material.scene_index;
    const auto reflected = [&](const MgfColour& colour, double share) {
        return converted(colour, share, largest_reflectance, material.defined);
    };
    const bool has_texture = !material.rd_texture.path.empty();  // its product with rd is limited, not rd
    const double max_transmitted = material.ts_texture.path.empty() ? largest_reflectance : 1;  // 1 is a hole
    Material result{.name = std::string(name),
                    .reflectance = has_texture ? converted(material.rd_colour, material.rd, 1, material.defined)
                                               : reflected(material.rd_colour, material.rd),
                    .exitance = emitted(material.ed_colour, material.ed, material.defined),
                    .reflectance_texture = texture(material.rd_texture),
                    .exitance_texture = texture(material.ed_texture),
                    .transmittance = converted(material.ts_colour, material.ts, max_transmitted, material.defined),
                    .transmittance_texture = texture(material.ts_texture),
                    .specular_reflectance = is_mirror(material.rs, material.rs_roughness)
                                                ? reflected(material.rs_colour, material.rs)
                                                : Rgb(0)};
    if (has_texture) {
        // Texels above 1 stay an error (require_products())
        Rgb largest = largest_texels_[result.reflectance_texture];
        for (int c = 0; c < 3; ++c) largest[c] = std::min(largest[c], 1.0f);
        if (limit_textured_reflectance(result.reflectance, largest)) warn_of_bright_reflectance(material.defined);
    }
    if (result.transmittance_texture == none && limit_sum(result))
        warn("reflectance-clamped", "more light than arrives would leave this material: rs and ts are reduced",
             material.defined);
    if (const std::string fault = exitance_fault(result.exitance); !fault.empty())
        throw InputError(*material.defined.file, material.defined.line, fault);
    require_products(result, material);
    const auto [entry, is_new] =
        material_index_.try_emplace(identity(result), static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
        scene_.materials.push_back(result);
        used_materials_.push_back(material);
    }
    return material.scene_index = entry->second;
}

std::uint32_t MgfSceneBuilder::object(const std::string& name) {
    const auto [entry, is_new] = object_index_.try_emplace(name, static_cast<std::uint32_t>(scene_.objects.size()));
    if (is_new) scene_.objects.push_back(name);
    return entry->second;
}

void MgfSceneBuilder::warn_of_lost(const std::string& kind, const std::string& what, double MgfMaterial::*share) {
    double lost = 0, all = 0;
    for (const MgfMaterial& m : used_materials_) {
        lost += m.*share;
        all += m.rd + m.td + m.rs + m.ts;
    }
    if (!(lost > 0)) return;
    const std::string message = fmt::format(
        "{} is left out: {:.1f}% of all that the materials in use reflect and transmit (mean over materials, not "
        "areas)",
        what, 100 * lost / all);
    for (const MgfMaterial& m : used_materials_)
        if (m.*share > 0) warn(kind, message, m.defined);
}

Scene MgfSceneBuilder::finish() {
    faces_.require_usable();
    warn_of_lost("specular-reflection", "specular reflectance (rs), but for mirrors in view of the camera,",
                 &MgfMaterial::rs);
    warn_of_lost("diffuse-transmission", "diffuse transmittance (td)", &MgfMaterial::td);
    for (const MgfMaterial& m : used_materials_)
        if (m.ts > 0 && m.ts_roughness > 0)
            warn("rough-transmission", "light goes through without being scattered, whatever the roughness of ts",
                 m.defined);
    return std::move(scene_);
}

}  // namespace interflect::detail
