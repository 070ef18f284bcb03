#include "interflect/exports/gltf/gltf_lightmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "interflect/base/files/escapes.h"
#include "interflect/exports/gltf/gltf_scene.h"
#include "interflect/exports/lightmap/lightmap.h"
#include "interflect/exports/mesh/display_range.h"
#include "interflect/exports/mesh/element_mesh.h"
#include "interflect/exports/mesh/welded_vertices.h"
#include "interflect/formats/text/extension.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail {

namespace {

struct MappedVertex {
    std::uint32_t point;
    V2f coordinate, lightmap_coordinate;
};

using MappedPrimitive = WeldedVertices<MappedVertex>;
using MappedPrimitives = std::map<std::tuple<std::uint32_t, std::uint32_t, int>, MappedPrimitive>;

/// Encoding of the images in a file. A linear texel of 1 represents `scale`, in the unit of `content`.
struct Encoding {
    LightmapContent content;
    float exposure;
    float scale = 1;

    float intensity() const { return scale * std::exp2(exposure); }
};

/// Returns Encoding::scale. For irradiance, it is the largest texel, but at most eight times the irradiance displayed
/// as white: a larger scale would make the steps of 8 bits visible in dark areas.
float scale_of(const std::vector<Image>& images, LightmapContent content, float exposure) {
    if (content == LightmapContent::radiance) return std::exp2(-exposure);
    constexpr float headroom = 8;
    float largest = 0;
    for (const Image& image : images)
        for (const Rgb& texel : image.pixels) largest = std::max(largest, largest_channel(texel));
    const float most = headroom * std::numbers::pi_v<float> * std::exp2(-exposure);
    return largest > 0 ? std::min(largest, most) : most;
}

/// Returns the name of an image, which differs between a .glb and a .gltf with the same stem.
std::string name_of_image(const std::filesystem::path& path, std::size_t page) {
    const bool is_text = lower_case_extension(path) == ".gltf";
    return fmt::format("{}.lightmap-{}", (is_text ? path.filename() : path.stem()).string(), page);
}

/// Returns the name of an image of a light group. It contains the number of the group, because its name may be invalid
/// in file names.
std::string name_of_image(const std::filesystem::path& path, std::size_t page, std::size_t group) {
    return fmt::format("{}-group-{}", name_of_image(path, page), group);
}

int add_image(GltfDocument& document, const Image& image, const std::string& name, float scale) {
    Image encoded = image;
    for (Rgb& texel : encoded.pixels) texel = within_display_range(texel / scale);
    return document.add_texture(encoded, name, false);
}

std::string encode_beside(const Image& image, const std::string& extension, const std::string& quantity) {
    if (extension == ".hdr") return codecs::encode_radiance(image);
    ImageMetadata metadata;
    metadata.quantity = quantity;
    metadata.version = INTERFLECT_VERSION;
    return codecs::encode_exr(image, metadata, {});
}

MappedPrimitives primitives_of(const Scene& scene, const Lightmap& lightmap, ElementMesh& mesh) {
    MappedPrimitives primitives;
    std::vector<MeshTriangle> triangles;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        if (lightmap.chart_of_patch[p] == none) continue;
        triangles.clear();
        mesh.triangulate(p, triangles);
        const Patch& patch = scene.patches[p];
        MappedPrimitive& primitive = primitives[{patch.object, patch.material, lightmap.page(p)}];
        for (const MeshTriangle& triangle : triangles)
            for (const MeshCorner& corner : triangle) {
                const V2f coordinate = coordinates_at(scene, patch, corner.at).texture.value_or(V2f(0, 0));
                primitive.add({corner.point, gltf_coordinate(coordinate), lightmap.coordinate(p, corner.at)});
            }
    }
    return primitives;
}

/// Writes a primitive. Lightmaps of radiance use TEXCOORD_0, because their materials have no other texture.
Json write_primitive(GltfDocument& document, const MappedPrimitive& primitive, const std::vector<V3f>& points,
                     bool is_textured, LightmapContent content) {
    Json attributes;
    const auto add = [&](const char* name, const auto& values) { attributes[name] = document.add_attribute(values); };
    attributes["POSITION"] =
        document.add_positions(primitive.values([&](const MappedVertex& v) { return points[v.point]; }));
    const auto coordinates = primitive.values([](const MappedVertex& v) { return v.coordinate; });
    const auto lightmap_coordinates = primitive.values([](const MappedVertex& v) { return v.lightmap_coordinate; });
    const bool has_both = content == LightmapContent::irradiance;
    add("TEXCOORD_0", has_both && is_textured ? coordinates : lightmap_coordinates);
    if (has_both) add("TEXCOORD_1", lightmap_coordinates);  // glTF allows it only together with TEXCOORD_0
    return {{"attributes", attributes}, {"indices", document.add_indices(primitive.indices())}};
}

void add_emission(GltfDocument& document, Json& json, GltfTextures& textures, const Material& material,
                  float exposure) {
    const Rgb emitted = material.exitance * (std::exp2(exposure) / std::numbers::pi_v<float>);
    const float strength = largest_channel(emitted);
    if (!(strength > 0)) return;
    const Rgb factor = emitted / strength;
    json["emissiveFactor"] = {factor.x, factor.y, factor.z};
    json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    document.use_extension("KHR_materials_emissive_strength");
    if (material.exitance_texture != none) json["emissiveTexture"] = textures.reference(material.exitance_texture);
}

int add_material(GltfDocument& document, GltfTextures& textures, const Material& material, int lightmap_texture,
                 const Encoding& encoding) {
    Json json{{"name", escaped(material.name)}};
    if (encoding.content == LightmapContent::radiance) {
        json["pbrMetallicRoughness"] = {
            {"baseColorTexture", {{"index", lightmap_texture}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
        json["extensions"] = {{"KHR_materials_unlit", Json::object()}};
        document.use_extension("KHR_materials_unlit");
    } else {
        json["pbrMetallicRoughness"] = textures.diffuse(material);
        if (material.transmittance_texture != none) textures.cut_out(json, material);
        // The default specular layer would reduce diffuse light.
        json["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
        document.use_extension("KHR_materials_specular");
        json["extensions"]["MOZ_lightmap"] = {
            {"index", lightmap_texture}, {"texCoord", 1}, {"intensity", encoding.intensity()}};
        document.use_extension("MOZ_lightmap");
        add_emission(document, json, textures, material, encoding.exposure);
    }
    return document.add("materials", std::move(json));
}

Json description_of(const Lightmap& lightmap, const Encoding& encoding, const std::vector<ExportedFile>& beside) {
    const bool holds_irradiance = encoding.content == LightmapContent::irradiance;
    Json images = Json::array();
    for (const ExportedFile& file : beside) images.push_back(escaped(file.path.filename().string()));
    return {{"exposure", encoding.exposure},
            {"lightmap",
             {{"quantity", holds_irradiance ? "irradiance" : "radiance"},
              {"unit", holds_irradiance ? "lm/m^2" : "cd/m^2"},
              {"encoding", "sRGB, 8 bit; a linear value of 1 stands for `scale`; brighter texels are scaled to it"},
              {"scale", encoding.scale},
              {"unclamped", images},
              {"used", lightmap.used},
              {"covered", lightmap.covered}}}};
}

Json add_groups(const std::filesystem::path& path, const Lightmap& lightmap, const std::vector<std::string>& names,
                const std::string& extension, const std::string& quantity, std::vector<ExportedFile>& files) {
    Json groups = Json::array();
    for (std::size_t g = 0; g < lightmap.groups.size(); ++g) {
        Json images = Json::array();
        for (std::size_t page = 0; page < lightmap.groups[g].size(); ++page) {
            const std::string name = name_of_image(path, page, g) + extension;
            files.push_back(
                {path.parent_path() / name, encode_beside(lightmap.groups[g][page], extension,
                                                          quantity + " of light group " + escaped(names[g]))});
            images.push_back(escaped(name));
        }
        groups.push_back({{"name", escaped(names[g])}, {"unclamped", images}});
    }
    return groups;
}

}  // namespace

std::vector<ExportedFile> add_lightmap(GltfDocument& document, const std::filesystem::path& path, const Scene& scene,
                                       const Solution& solution, const ExportOptions& options) {
    const LightmapOptions& chosen = *options.lightmap;
    const Lightmap lightmap = make_lightmap(scene, solution, options);
    const Encoding encoding{chosen.content, options.exposure,
                            scale_of(lightmap.images, chosen.content, options.exposure)};
    const std::string quantity =
        chosen.content == LightmapContent::irradiance ? "irradiance [lm/m^2]" : "radiance [cd/m^2]";
    std::vector<ExportedFile> files;
    std::vector<int> images;
    for (std::size_t page = 0; page < lightmap.images.size(); ++page) {
        const std::string name = name_of_image(path, page);
        images.push_back(add_image(document, lightmap.images[page], name, encoding.scale));
        files.push_back(
            {path.parent_path() / (name + chosen.image), encode_beside(lightmap.images[page], chosen.image, quantity)});
    }

    const ElementForest patches(scene, scene.patches.size());
    ElementMesh mesh(scene, patches, std::vector<Rgb>(scene.patches.size(), Rgb(0)));
    GltfTextures textures(document, scene);
    std::map<std::pair<std::uint32_t, int>, int> materials;
    GltfPrimitives written;
    for (const auto& [key, primitive] : primitives_of(scene, lightmap, mesh)) {
        const auto& [object, material, page] = key;
        const auto [entry, is_new] = materials.try_emplace({material, page}, 0);
        if (is_new)
            entry->second = add_material(document, textures, scene.materials[material],
                                         images[static_cast<std::size_t>(page)], encoding);
        Json json = write_primitive(document, primitive, mesh.points(), scene.materials[material].is_textured(),
                                    chosen.content);
        json["material"] = entry->second;
        written[object].push_back(std::move(json));
    }
    Json description = description_of(lightmap, encoding, files);
    if (!lightmap.groups.empty())
        description["lightmap"]["groups"] =
            add_groups(path, lightmap, solution.group_names, chosen.image, quantity, files);
    document.json["asset"]["extras"]["interflect"] = std::move(description);
    add_nodes(document, scene, written, options.up);
    return files;
}

}  // namespace interflect::detail
