#include "interflect/formats/gltf/parts/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "interflect/formats/build/colour.h"
#include "interflect/scene/core/limits.h"

namespace interflect::detail {

namespace {

constexpr auto max_reflected = static_cast<float>(largest_reflectance);

/// Reflectance in place of glTF's default material, which does not reflect diffusely.
constexpr float default_reflectance = 0.5f;

GltfMapping mapping_of(const GltfValue& use) {
    GltfMapping result;
    const GltfValue transform = use.extension("KHR_texture_transform");
    result.set = transform.integer("texCoord", use.integer("texCoord", 0));
    const auto offset = transform.numbers<2>("offset", {0, 0}), scale = transform.numbers<2>("scale", {1, 1});
    const double angle = transform.number("rotation", 0), c = std::cos(angle), s = std::sin(angle);
    result.xx = c * scale[0];
    result.xy = s * scale[1];
    result.x = offset[0];
    result.yx = -s * scale[0];
    result.yy = c * scale[1];
    result.y = offset[1];
    return result;
}

}  // namespace

/// Properties of a material in the file.
struct GltfMaterials::Parts {
    Rgb base{1, 1, 1};
    GltfTextureUse base_texture;
    float metallic = 1;
    GltfTextureUse metallic_texture;
    Rgb emissive{0, 0, 0};  ///< [cd/m^2]
    GltfTextureUse emissive_texture;
    float transmission = 0;  ///< mean over the texture
    GltfTextureUse coverage_texture;
    float coverage = 1;  ///< opaque fraction of the surface, or the factor of alpha
    float cutoff = 0;
    std::optional<GltfMapping> mapping;

    GltfCoverage coverage_from_texture() const { return {coverage_texture.image, coverage, cutoff}; }
    /// Returns the coverage unless a texture determines it.
    float even_coverage() const { return coverage_texture.image == none ? coverage : 1; }
};

GltfMaterials::GltfMaterials(GltfAsset& asset, GltfImages& images)
    : asset_(asset), images_(images), materials_(asset.root().objects("materials")) {}

GltfTextureUse GltfMaterials::use_of(const GltfValue& owner, const char* key) {
    const GltfValue use = owner.object(key);
    if (!use.exists()) return {};
    const std::uint32_t texture = use.required_index("index", images_.texture_count());
    return {images_.image_of_texture(texture), mapping_of(use), images_.repeats(texture)};
}

void GltfMaterials::warn_of_ignored(const GltfValue& owner) {
    if (owner.has("normalTexture"))
        asset_.warn("normal-texture", "normal maps are ignored: faces are flat", owner.place());
    const auto warn_of = [&](const char* layer, auto is_visible) {
        const GltfValue extension = owner.extension(layer);
        if (extension.exists() && is_visible(extension))
            asset_.warn("specular-reflection", fmt::format("{} is ignored: reflection is diffuse", layer),
                        owner.place());
    };
    const auto if_positive = [](const char* factor) {
        return [=](const GltfValue& extension) { return extension.number(factor, 0) > 0; };
    };
    constexpr std::array<double, 3> black{0, 0, 0}, white{1, 1, 1};
    warn_of("KHR_materials_clearcoat", if_positive("clearcoatFactor"));
    warn_of("KHR_materials_iridescence", if_positive("iridescenceFactor"));
    warn_of("KHR_materials_anisotropy", if_positive("anisotropyStrength"));
    warn_of("KHR_materials_sheen",
            [&](const GltfValue& sheen) { return sheen.numbers<3>("sheenColorFactor", black) != black; });
    // Blender writes diffuse materials (Specular 0) with factor 1 and black.
    warn_of("KHR_materials_specular", [&](const GltfValue& specular) {
        return specular.number("specularFactor", 1) > 0 && specular.numbers<3>("specularColorFactor", white) != black;
    });
    if (owner.extension("KHR_materials_volume").exists())
        asset_.warn("volume", "KHR_materials_volume is ignored: each of its faces is a thin pane", owner.place());
}

GltfMaterials::Parts GltfMaterials::parts_of(const GltfValue& owner) {
    Parts parts;
    const GltfValue rough = owner.object("pbrMetallicRoughness");
    const GltfValue glossy = owner.extension("KHR_materials_pbrSpecularGlossiness");
    const GltfValue& basis = glossy.exists() ? glossy : rough;
    const auto base = basis.numbers<4>(glossy.exists() ? "diffuseFactor" : "baseColorFactor", {1, 1, 1, 1});
    for (int c = 0; c < 3; ++c)
        parts.base[c] = static_cast<float>(std::clamp(base[static_cast<std::size_t>(c)], 0.0, 1.0));
    parts.coverage = static_cast<float>(std::clamp(base[3], 0.0, 1.0));
    parts.base_texture = use_of(basis, glossy.exists() ? "diffuseTexture" : "baseColorTexture");
    if (owner.extension("KHR_materials_unlit").exists()) {
        parts.metallic = 0;
        asset_.warn("unlit", "an unlit material's colour is taken as its reflectance; it emits no light",
                    owner.place());
        return parts;
    }
    parts.metallic = glossy.exists() ? 0 : static_cast<float>(std::min(rough.amount("metallicFactor", 1), 1.0));
    if (parts.metallic > 0) parts.metallic_texture = use_of(rough, "metallicRoughnessTexture");
    const auto strength =
        static_cast<float>(owner.extension("KHR_materials_emissive_strength").amount("emissiveStrength", 1));
    parts.emissive = owner.colour("emissiveFactor", Rgb(0)) * strength;
    if (largest_channel(parts.emissive) > 0) parts.emissive_texture = use_of(owner, "emissiveTexture");
    const GltfValue transmission = owner.extension("KHR_materials_transmission");
    parts.transmission = static_cast<float>(std::min(transmission.amount("transmissionFactor", 0), 1.0));
    const GltfTextureUse use = use_of(transmission, "transmissionTexture");
    if (parts.transmission > 0 && use.image != none) {
        parts.transmission *= images_.means(use.image).stored.x;
        asset_.warn("transmission-texture", "a texture of transmission is replaced by its mean", owner.place());
    }
    return parts;
}

void GltfMaterials::apply_alpha(const GltfValue& owner, Parts& parts, GltfSurface& surface) {
    const std::string mode = owner.text("alphaMode", "OPAQUE");
    if (mode == "OPAQUE") {
        parts.coverage = 1;
        return;
    }
    if (mode != "MASK" && mode != "BLEND") owner.fail("its alphaMode is unknown");
    const std::uint32_t image = parts.base_texture.image;
    if (image != none && images_.means(image).min_alpha < 1) parts.coverage_texture = parts.base_texture;
    if (mode != "MASK") return;
    parts.cutoff = static_cast<float>(owner.amount("alphaCutoff", 0.5));
    surface.is_invisible = parts.coverage < parts.cutoff;
    if (parts.coverage_texture.image == none || parts.cutoff == 0) {
        parts.coverage = 1;
        parts.coverage_texture.image = none;
    }
}

void GltfMaterials::choose_mapping(const GltfValue& owner, Parts& parts, bool textured) {
    GltfTextureUse* const uses[] = {&parts.coverage_texture, &parts.emissive_texture, &parts.base_texture,
                                    &parts.metallic_texture};
    if (textured)
        for (const GltfTextureUse* use : uses)
            if (use->image != none && !parts.mapping) parts.mapping = use->mapping;
    const auto is_lost = [&](const GltfTextureUse& use) { return use.image != none && parts.mapping != use.mapping; };
    for (GltfTextureUse* use : uses) {
        if (!is_lost(*use)) continue;
        const GltfImageMeans& means = images_.means(use->image);
        if (use == &parts.coverage_texture) parts.coverage *= means.alpha;
        if (use == &parts.emissive_texture) parts.emissive *= means.colour;
        if (use == &parts.base_texture) parts.base *= means.colour;
        if (use == &parts.metallic_texture) parts.metallic *= means.stored.z;
        use->image = none;
        asset_.warn("texture-coordinates",
                    textured ? "a texture with other coordinates than the material's first one is replaced by its mean"
                             : "textures without coordinates are replaced by their means",
                    owner.place());
    }
}

void GltfMaterials::reflect(const GltfValue& owner, const Parts& parts, Material& material) {
    const std::uint32_t colour = parts.base_texture.image, metallic = parts.metallic_texture.image;
    const float reflected = parts.even_coverage() * (1 - parts.transmission);
    material.reflectance = parts.base * reflected;
    bool is_reduced = false;
    if (colour == none && metallic == none && parts.coverage_texture.image == none) {
        material.reflectance *= 1 - parts.metallic;
        is_reduced = largest_channel(material.reflectance) > max_reflected;
        for (int c = 0; c < 3; ++c) material.reflectance[c] = std::min(material.reflectance[c], max_reflected);
    } else {
        GltfTexels texels{colour, metallic, parts.metallic, Rgb(1), parts.coverage_from_texture()};
        for (int c = 0; c < 3; ++c) {
            texels.factor[c] = std::max(1.0f, material.reflectance[c] / max_reflected);
            material.reflectance[c] = std::min(material.reflectance[c], max_reflected);
        }
        std::tie(material.reflectance_texture, is_reduced) = images_.texture(texels);
    }
    if (is_reduced)
        asset_.warn("reflectance-clamped",
                    "diffuse reflectance above 0.99, at least in one colour channel, is reduced to 0.99",
                    owner.place());
    const Rgb mean = material.reflectance_texture == none || colour == none
                         ? parts.base
                         : Rgb(parts.base * images_.means(colour).colour);
    const float share = metallic == none ? parts.metallic : parts.metallic * images_.means(metallic).stored.z;
    all_ += channel_sum(mean);
    lost_ += channel_sum(mean) * share;
    if (channel_sum(mean) * share > 0) losing_.push_back(owner.place());
}

void GltfMaterials::transmit(const GltfValue& owner, const Parts& parts, Material& material) {
    const GltfCoverage coverage = parts.coverage_from_texture();
    if (parts.transmission == 0 && parts.coverage == 1 && coverage.image == none) return;
    Rgb base = parts.base;
    float metallic = parts.metallic;
    if (parts.base_texture.image != none) base *= images_.means(parts.base_texture.image).colour;
    if (parts.metallic_texture.image != none) metallic *= images_.means(parts.metallic_texture.image).stored.z;
    if (parts.transmission > 0 && parts.base_texture.image != none)
        asset_.warn("transmission-texture", "transmitted light has the mean colour of the surface's texture",
                    owner.place());
    constexpr float above_rounding = 1 - 0x1p-20f;                     // keeps rounded sums at most 1
    const Rgb through = base * (parts.transmission * (1 - metallic));  // transmitted by the opaque parts
    if (coverage.image != none) {
        material.transmittance = Rgb(1);
        material.transmittance_texture =
            images_.texture({.factor = through * above_rounding, .coverage = coverage, .open = Rgb(1)}).first;
        return;
    }
    material.transmittance = through * parts.coverage + Rgb(1 - parts.coverage);
    const float rest = 1 - largest_channel(parts.base) * parts.coverage * (1 - parts.transmission);
    if (const float most = largest_channel(material.transmittance); most > rest * above_rounding)
        material.transmittance *= std::max(rest, 0.0f) * above_rounding / most;
}

GltfSurface GltfMaterials::make_default() {
    GltfSurface surface;
    surface.material = static_cast<std::uint32_t>(asset_.model.materials.size());
    asset_.model.materials.push_back({"default", Rgb(default_reflectance)});
    asset_.warn("no-material", fmt::format("faces without a material get a reflectance of {}", default_reflectance),
                "meshes");
    return surface;
}

GltfSurface GltfMaterials::make(std::uint32_t index, bool textured) {
    if (index == none) return make_default();
    const GltfValue& owner = materials_[index];
    Parts parts = parts_of(owner);
    GltfSurface surface;
    surface.double_sided = owner.flag("doubleSided", false);
    apply_alpha(owner, parts, surface);
    choose_mapping(owner, parts, textured);
    surface.mapping = parts.mapping;
    for (const GltfTextureUse* use :
         {&parts.coverage_texture, &parts.emissive_texture, &parts.base_texture, &parts.metallic_texture})
        surface.repeats &= use->image == none || use->repeats;
    warn_of_ignored(owner);

    Material material;
    material.name = owner.text("name", fmt::format("material-{}", index));
    reflect(owner, parts, material);
    transmit(owner, parts, material);
    material.exitance = parts.emissive * (parts.even_coverage() * std::numbers::pi_v<float>);
    if (const std::string fault = exitance_fault(material.exitance); !fault.empty()) owner.fail("its " + fault);
    if (largest_channel(material.exitance) > 0)
        material.exitance_texture =
            images_.texture({.colour = parts.emissive_texture.image, .coverage = parts.coverage_from_texture()}).first;
    images_.limit_textures();
    surface.material = static_cast<std::uint32_t>(asset_.model.materials.size());
    asset_.model.materials.push_back(std::move(material));
    return surface;
}

const GltfSurface& GltfMaterials::surface(std::uint32_t index, bool textured) {
    const auto found = surfaces_.find({index, textured});
    if (found != surfaces_.end()) return found->second;
    if (!textured && !surface(index, true).mapping) return surface(index, true);
    return surfaces_.emplace(std::pair(index, textured), make(index, textured)).first->second;
}

std::uint32_t GltfMaterials::tinted(std::uint32_t material, const Rgb& tint) {
    if (tint == Rgb(1)) return material;
    std::vector<Material>& materials = asset_.model.materials;
    const auto [entry, is_new] =
        tinted_.try_emplace({material, tint.x, tint.y, tint.z}, static_cast<std::uint32_t>(materials.size()));
    if (is_new) {
        Material result = materials[material];
        result.reflectance *= tint;
        materials.push_back(std::move(result));
    }
    return entry->second;
}

void GltfMaterials::warn_of_lost_reflection() {
    const std::string message = fmt::format(
        "specular reflection of metals is left out: {:.1f}% of all that the materials in use reflect (mean over "
        "materials, not areas)",
        100 * lost_ / all_);
    for (const std::string& place : losing_) asset_.warn("specular-reflection", message, place);
}

}  // namespace interflect::detail
