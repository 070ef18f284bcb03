#include "interflect/exports/authored/lit_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/gltf/baked_light.h"

namespace interflect::detail {

namespace {

constexpr const char* lightmap_extension = "MOZ_lightmap";
constexpr const char* khr_emissive_strength = "KHR_materials_emissive_strength";
constexpr const char* khr_unlit = "KHR_materials_unlit";
constexpr const char* khr_variants = "KHR_materials_variants";

bool has_extension(const Json& json, const char* name) {
    return json.contains("extensions") && json["extensions"].contains(name);
}

/// Returns the highest set of texture coordinates that a material uses at any depth, except for earlier lightmaps.
int highest_set(const Json& json) {
    int highest = 0;
    if (!json.is_structured()) return highest;
    for (const auto& [key, value] : json.items()) {
        if (key == lightmap_extension || key == "extras") continue;
        highest =
            std::max(highest, key == "texCoord" && value.is_number_integer() ? value.get<int>() : highest_set(value));
    }
    return highest;
}

/// Whether a material shows mostly the diffuse light of an opaque surface.
bool is_diffuse(const Json& material) {
    if (has_extension(material, "KHR_materials_transmission")) return false;
    if (material.value("alphaMode", "OPAQUE") != "OPAQUE") return false;
    if (!material.contains("pbrMetallicRoughness")) return false;  // glTF's default is a metal
    const Json& surface = material["pbrMetallicRoughness"];
    constexpr double mostly = 0.5;
    return surface.value("metallicFactor", 1.0) <= mostly || surface.contains("metallicRoughnessTexture");
}

/// Returns the material of primitives without one, as in the scene reader.
Json unnamed_material() {
    return {{"name", "default"},
            {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}}};
}

}  // namespace

LitMaterials::LitMaterials(GltfDocument& document, const LightmapImages& images)
    : document_(document), images_(images) {
    if (!document.json.contains("materials")) return;
    Json& materials = document.json["materials"];
    set_ = 1 + highest_set(materials);
    constexpr int most_sets = 8;  // more than any viewer reads
    if (set_ >= most_sets)
        throw InputError(fmt::format("a material uses TEXCOORD_{}; expected at most TEXCOORD_{}, beside the lightmap's",
                                     set_ - 1, most_sets - 2));
    bool emits = false;
    for (Json& material : materials) {
        if (!material.contains("emissiveFactor") || has_extension(material, khr_unlit)) continue;
        const auto& factor = material["emissiveFactor"];
        if (std::none_of(factor.begin(), factor.end(), [](const Json& x) { return x.get<double>() > 0; })) continue;
        Json& strength = material["extensions"][khr_emissive_strength]["emissiveStrength"];
        strength = (strength.is_number() ? strength.get<double>() : 1.0) * std::exp2(images.encoding.exposure);
        emits = true;
    }
    if (emits) document.use_extension(khr_emissive_strength);
}

Json LitMaterials::with_irradiance(Json material, int page) const {
    material["extensions"][lightmap_extension] = moz_lightmap(images_, page, set_);
    return material;
}

Json LitMaterials::as_radiance(const Json& material, int page) const {
    Json json;
    if (material.contains("name")) json["name"] = material["name"];
    const Json texture = {{"index", images_.textures[static_cast<std::size_t>(page)]}, {"texCoord", set_}};
    json["pbrMetallicRoughness"] = {{"baseColorTexture", texture}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (material.contains("doubleSided")) json["doubleSided"] = material["doubleSided"];
    json["extensions"][khr_unlit] = Json::object();
    return json;
}

int LitMaterials::lit(int material, int page) {
    const auto [entry, is_new] = lit_.try_emplace({material, page}, material);
    if (!is_new) return entry->second;
    const bool is_first = first_page_.try_emplace(material, page).first->second == page;
    const Json json =
        material < 0 ? unnamed_material() : document_.json.at("materials").at(static_cast<std::size_t>(material));
    if (has_extension(json, khr_unlit)) return material;
    if (images_.encoding.content != LightmapContent::irradiance) {
        if (images_.encoding.content == LightmapContent::radiance && !is_diffuse(json)) return material;
        document_.use_extension(khr_unlit);
        return entry->second = document_.add("materials", as_radiance(json, page));
    }
    document_.use_extension(lightmap_extension);
    if (material < 0 || !is_first || kept_.contains(material))
        return entry->second = document_.add("materials", with_irradiance(json, page));
    document_.json["materials"][material] = with_irradiance(json, page);
    return material;
}

void LitMaterials::add_variants(Json& primitive, int authored, int lit) {
    if (!first_variant_) {
        Json& names = document_.json["extensions"][khr_variants]["variants"];
        first_variant_ = static_cast<int>(names.size());
        names.push_back({{"name", lit_variant}});
        names.push_back({{"name", authored_variant}});
        document_.use_extension(khr_variants);
    }
    Json& mappings = primitive["extensions"][khr_variants]["mappings"];
    mappings.push_back({{"material", lit}, {"variants", {*first_variant_}}});
    mappings.push_back({{"material", authored}, {"variants", {*first_variant_ + 1}}});
}

void LitMaterials::keep(const Json& primitive) {
    kept_.insert(primitive.value("material", -1));
    if (has_extension(primitive, khr_variants))
        for (const Json& mapping : primitive["extensions"][khr_variants]["mappings"])
            kept_.insert(mapping["material"].get<int>());
}

void LitMaterials::light(Json& primitive, int page) {
    const int own = primitive.value("material", -1), material = lit(own, page);
    if (material >= 0) primitive["material"] = material;
    if (images_.encoding.content != LightmapContent::irradiance) {
        if (own >= 0 && material != own) add_variants(primitive, own, material);
    } else if (has_extension(primitive, khr_variants)) {
        for (Json& mapping : primitive["extensions"][khr_variants]["mappings"])
            mapping["material"] = lit(mapping["material"].get<int>(), page);
    }
}

}  // namespace interflect::detail
