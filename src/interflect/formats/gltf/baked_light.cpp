#include "interflect/formats/gltf/baked_light.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

namespace interflect::detail {

namespace {

constexpr const char* lightmap_extension = "MOZ_lightmap";
constexpr const char* khr_emissive_strength = "KHR_materials_emissive_strength";
constexpr const char* khr_variants = "KHR_materials_variants";

/// Returns the value at a path of keys; null if it is missing.
template <class Json>
Json* find(Json& value, std::initializer_list<const char*> path) {
    Json* found = &value;
    for (const char* key : path) {
        if (!found->is_object() || !found->contains(key)) return nullptr;
        found = &(*found)[key];
    }
    return found;
}

template <class Json>
Json* list(Json& value, std::initializer_list<const char*> path) {
    Json* found = find(value, path);
    return found && found->is_array() ? found : nullptr;
}

template <class Json>
std::optional<std::uint64_t> number(Json& value, std::initializer_list<const char*> path) {
    const Json* found = find(value, path);
    if (!found || !found->is_number_unsigned()) return std::nullopt;
    return found->template get<std::uint64_t>();
}

/// Returns the index of a variant.
template <class Json>
std::optional<std::uint64_t> find_variant(Json& root, const char* name) {
    Json* variants = list(root, {"extensions", khr_variants, "variants"});
    for (std::size_t i = 0; variants && i < variants->size(); ++i)
        if (const Json* found = find((*variants)[i], {"name"}); found && *found == name) return i;
    return std::nullopt;
}

/// Removes a variant from a primitive; returns its material.
template <class Json>
std::optional<std::uint64_t> take_variant(Json& primitive, std::uint64_t variant) {
    Json* mappings = list(primitive, {"extensions", khr_variants, "mappings"});
    for (std::size_t i = 0; mappings && i < mappings->size(); ++i) {
        Json* variants = list((*mappings)[i], {"variants"});
        if (!variants || *variants != Json::array({variant})) continue;
        const std::optional<std::uint64_t> material = number((*mappings)[i], {"material"});
        mappings->erase(i);
        return material;
    }
    return std::nullopt;
}

template <class Json>
class BakedLightRemover {
  public:
    explicit BakedLightRemover(Json& root)
        : root_(root), lit_(find_variant(root, lit_variant)), authored_(find_variant(root, authored_variant)) {
        const Json* stops = find(root, {"asset", "extras", "interflect", "exposure"});
        if (stops && stops->is_number()) gain_ = std::exp2(stops->template get<double>());
    }

    void remove() {
        if (Json* meshes = list(root_, {"meshes"}))
            for (Json& mesh : *meshes)
                if (Json* primitives = list(mesh, {"primitives"}))
                    for (Json& primitive : *primitives) remove_from(primitive);
        if (Json* materials = list(root_, {"materials"}))
            for (Json& material : *materials) remove_from_material(material);
        remove_variants();
        if (Json* used = list(root_, {"extensionsUsed"}))
            for (std::size_t i = used->size(); i-- > 0;)
                if ((*used)[i] == lightmap_extension) used->erase(i);
        remove_last("materials", materials_);
        remove_last("textures", textures_);
        remove_last("images", images_);
    }

  private:
    /// Returns the set of texture coordinates of the lightmap in a material.
    std::optional<std::uint64_t> lightmap_set(std::uint64_t material, bool is_radiance) {
        Json* materials = list(root_, {"materials"});
        if (!materials || material >= materials->size()) return std::nullopt;
        return is_radiance ? number((*materials)[material], {"pbrMetallicRoughness", "baseColorTexture", "texCoord"})
                           : number((*materials)[material], {"extensions", lightmap_extension, "texCoord"});
    }

    /// Removes lightmaps from a material, and the file's exposure from its emission.
    void remove_from_material(Json& material) {
        mark_texture(number(material, {"extensions", lightmap_extension, "index"}));
        mark_texture(number(material, {"extensions", lightmap_extension, "extras", "gain", "index"}));
        if (Json* strength = find(material, {"extensions", khr_emissive_strength, "emissiveStrength"});
            strength && strength->is_number())
            *strength = strength->template get<double>() / gain_;
        if (Json* extensions = find(material, {"extensions"}); extensions && extensions->is_object())
            extensions->erase(lightmap_extension);
    }

    void remove_variants() {
        if (!lit_ || authored_ != *lit_ + 1) return;
        Json& variants = *list(root_, {"extensions", khr_variants, "variants"});
        if (variants.size() != *lit_ + 2) return;
        variants.erase(*authored_);
        variants.erase(*lit_);
        if (variants.empty()) root_["extensions"].erase(khr_variants);
    }

    /// Removes the lightmaps' entries at the end of a list, which changes no other index.
    void remove_last(const char* name, const std::set<std::uint64_t>& unused) {
        Json* entries = list(root_, {name});
        while (entries && !entries->empty() && unused.contains(entries->size() - 1))
            entries->erase(entries->size() - 1);
        if (entries && entries->empty()) root_.erase(name);
    }

    /// Marks a material and its lightmap for removal.
    void mark_lit_material(std::uint64_t material) {
        materials_.insert(material);
        Json* materials = list(root_, {"materials"});
        if (materials && material < materials->size())
            mark_texture(number((*materials)[material], {"pbrMetallicRoughness", "baseColorTexture", "index"}));
    }

    void mark_texture(std::optional<std::uint64_t> texture) {
        if (!texture) return;
        textures_.insert(*texture);
        Json* textures = list(root_, {"textures"});
        if (!textures || *texture >= textures->size()) return;
        if (const auto image = number((*textures)[*texture], {"source"})) images_.insert(*image);
    }

    void remove_from(Json& primitive) {
        std::optional<std::uint64_t> set;
        if (const auto material = number(primitive, {"material"})) set = lightmap_set(*material, false);
        if (lit_ && authored_)
            if (const auto lit = take_variant(primitive, *lit_)) {
                set = lightmap_set(*lit, true);
                mark_lit_material(*lit);
                if (const auto authored = take_variant(primitive, *authored_)) primitive["material"] = *authored;
                if (list(primitive, {"extensions", khr_variants, "mappings"})->empty())
                    primitive["extensions"].erase(khr_variants);
            }
        Json* attributes = find(primitive, {"attributes"});
        if (set && attributes && attributes->is_object()) attributes->erase(fmt::format("TEXCOORD_{}", *set));
    }

    Json& root_;
    double gain_ = 1;  // factor of emission by the file's exposure
    std::optional<std::uint64_t> lit_, authored_;
    std::set<std::uint64_t> materials_, textures_, images_;  // indices of entries that only lightmaps use
};

}  // namespace

template <class Json>
bool remove_baked_light(Json& root) {
    if (!find(root, {"asset", "extras", "interflect"})) return false;
    BakedLightRemover(root).remove();
    return true;
}

template bool remove_baked_light(nlohmann::json&);
template bool remove_baked_light(nlohmann::ordered_json&);

}  // namespace interflect::detail
