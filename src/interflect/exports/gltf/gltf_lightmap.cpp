#include "interflect/exports/gltf/gltf_lightmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "interflect/base/files/escapes.h"
#include "interflect/exports/gltf/gltf_scene.h"
#include "interflect/exports/gltf/lightmap_images.h"
#include "interflect/exports/lightmap/lightmap.h"
#include "interflect/exports/mesh/element_mesh.h"
#include "interflect/exports/mesh/welded_vertices.h"
#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect::detail {

namespace {

struct MappedVertex {
    std::uint32_t point;
    V2f coordinate, lightmap_coordinate;
};

using MappedPrimitive = WeldedVertices<MappedVertex>;
/// Primitives by object, material and page.
using MappedPrimitives = std::map<std::tuple<std::uint32_t, std::uint32_t, int>, MappedPrimitive>;

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

int add_material(GltfDocument& document, GltfTextures& textures, const Material& material, const LightmapImages& images,
                 int page) {
    Json json{{"name", escaped(material.name)}};
    if (images.encoding.content != LightmapContent::irradiance) {
        const int texture = images.textures[static_cast<std::size_t>(page)];
        json["pbrMetallicRoughness"] = {
            {"baseColorTexture", {{"index", texture}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
        json["extensions"] = {{"KHR_materials_unlit", Json::object()}};
        document.use_extension("KHR_materials_unlit");
    } else {
        json["pbrMetallicRoughness"] = textures.diffuse(material);
        if (material.transmittance_texture != none) textures.cut_out(json, material);
        // The default specular layer would reduce diffuse light.
        json["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
        document.use_extension("KHR_materials_specular");
        json["extensions"]["MOZ_lightmap"] = moz_lightmap(images, page, 1);
        document.use_extension("MOZ_lightmap");
        add_emission(document, json, textures, material, images.encoding.exposure);
    }
    return document.add("materials", std::move(json));
}

}  // namespace

std::vector<ExportedFile> add_lightmap(GltfDocument& document, const std::filesystem::path& path, const Scene& scene,
                                       const Solution& solution, const ExportOptions& options,
                                       const EarlierLightmap* earlier) {
    if (!solution.forest)
        throw InputError(
            "lightmap: the layout of a scene that is written anew depends on its light: expected a solution");
    const Lightmap lightmap = make_lightmap(scene, solution, options, earlier);
    LightmapImages images = add_lightmap_images(document, path, lightmap, solution.group_names, options, earlier);
    const ElementForest patches(scene, scene.patches.size());
    ElementMesh mesh(scene, patches, std::vector<Rgb>(scene.patches.size(), Rgb(0)));
    GltfTextures textures(document, scene);
    std::map<std::pair<std::uint32_t, int>, int> materials;
    GltfPrimitives written;
    for (const auto& [key, primitive] : primitives_of(scene, lightmap, mesh)) {
        const auto& [object, material, page] = key;
        const auto [entry, is_new] = materials.try_emplace({material, page}, 0);
        if (is_new) entry->second = add_material(document, textures, scene.materials[material], images, page);
        Json json = write_primitive(document, primitive, mesh.points(), scene.materials[material].is_textured(),
                                    images.encoding.content);
        json["material"] = entry->second;
        written[object].push_back(std::move(json));
    }
    add_nodes(document, scene, written, options.up);
    return std::move(images.files);
}

}  // namespace interflect::detail
