#include "interflect/exports/gltf/gltf_vertex_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/base/files/escapes.h"
#include "interflect/exports/gltf/gltf_scene.h"
#include "interflect/exports/mesh/display_range.h"
#include "interflect/exports/mesh/opacity.h"
#include "interflect/exports/mesh/welded_vertices.h"
#include "interflect/exports/vertices/vertex_light.h"
#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect::detail {

namespace {

/// Returns whether the file contains the reflectance texture, which viewers multiply by the colours of vertices.
bool keeps_texture(const Material& material) {
    return material.reflectance_texture != none && !(channel_sum(material.exitance) > 0);
}

struct LitVertex {
    std::uint32_t point;
    Rgb irradiance, colour;
    V2f coordinate;
};

/// Returns the largest texel of the reflectance, channel by channel; 1 for black channels.
Rgb peak_of(const Scene& scene, const Material& material) {
    Rgb peak = material.transmittance_texture == none
                   ? largest_texel(scene.textures[material.reflectance_texture])
                   : largest_texel(opaque_reflectance(scene, material, opacity_of(scene, material)));
    for (int k = 0; k < 3; ++k)
        if (!(peak[k] > 0)) peak[k] = 1;
    return peak;
}

class VertexColours {
  public:
    VertexColours(const Scene& scene, float exposure)
        : scene_(scene), scale_(std::exp2(exposure) / std::numbers::pi_v<float>) {
        for (const Material& material : scene.materials)
            brightest_.push_back(keeps_texture(material) ? material.reflectance * peak_of(scene, material) : Rgb(0));
    }

    LitVertex vertex(const Patch& patch, const MeshCorner& corner) const {
        if (keeps_texture(scene_.materials[patch.material]))
            return {corner.point, corner.irradiance,
                    within_display_range(scale_ * brightest_[patch.material] * corner.irradiance),
                    gltf_coordinate(texture_coordinate(scene_, patch, corner.at))};
        const Rgb reflected = reflectance_at(scene_, patch, corner.at) * corner.irradiance;
        const Rgb radiosity = exitance_at(scene_, patch, corner.at) + reflected;
        const V2f coordinate = coordinates_at(scene_, patch, corner.at).texture.value_or(V2f(0, 0));
        return {corner.point, corner.irradiance, within_display_range(scale_ * radiosity), gltf_coordinate(coordinate)};
    }

  private:
    const Scene& scene_;
    float scale_;
    std::vector<Rgb> brightest_;  // reflectance of the brightest texel of each material
};

using LitPrimitive = WeldedVertices<LitVertex>;

Json write_primitive(GltfDocument& document, const LitPrimitive& primitive, const std::vector<V3f>& points,
                     const Material& material) {
    Json attributes;
    const auto add = [&](const char* name, const auto& values) { attributes[name] = document.add_attribute(values); };
    attributes["POSITION"] =
        document.add_positions(primitive.values([&](const LitVertex& v) { return points[v.point]; }));
    add("COLOR_0", primitive.values([](const LitVertex& v) { return v.colour; }));
    add("_IRRADIANCE", primitive.values([](const LitVertex& v) { return v.irradiance; }));
    if (keeps_texture(material) || material.transmittance_texture != none)
        add("TEXCOORD_0", primitive.values([](const LitVertex& v) { return v.coordinate; }));
    return {{"attributes", attributes}, {"indices", document.add_indices(primitive.indices())}};
}

int add_material(GltfDocument& document, GltfTextures& textures, const Scene& scene, const Material& material) {
    Json json{{"name", escaped(material.name)},
              {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
              {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
    const Rgb peak = keeps_texture(material) ? peak_of(scene, material) : Rgb(1);
    if (material.transmittance_texture != none)
        textures.cut_out(json, material, peak);
    else if (keeps_texture(material))
        json["pbrMetallicRoughness"]["baseColorTexture"] = textures.reference(material.reflectance_texture, peak);
    return document.add("materials", std::move(json));
}

/// Primitives by object and material.
using LitPrimitives = std::map<std::pair<std::uint32_t, std::uint32_t>, LitPrimitive>;

LitPrimitives primitives_of(const Scene& scene, VertexLight& light, float exposure) {
    const ElementForest& forest = *light.forest;
    const VertexColours colours(scene, exposure);
    LitPrimitives primitives;
    std::vector<MeshTriangle> triangles;
    for (const ElementIndex leaf : forest.leaves()) {
        if (!light.shown[forest.patch(leaf)]) continue;
        triangles.clear();
        light.mesh.triangulate(leaf, triangles);
        const Patch& patch = scene.patches[forest.patch(leaf)];
        LitPrimitive& primitive = primitives[{patch.object, patch.material}];
        for (const MeshTriangle& triangle : triangles)
            for (const MeshCorner& corner : triangle) primitive.add(colours.vertex(patch, corner));
    }
    return primitives;
}

}  // namespace

void add_vertex_light(GltfDocument& document, const Scene& scene, const Solution& solution,
                      const ExportOptions& options) {
    VertexLight light = make_vertex_light(scene, solution, options);
    const LitPrimitives primitives = primitives_of(scene, light, options.exposure);
    GltfTextures textures(document, scene);
    std::map<std::uint32_t, int> materials;
    GltfPrimitives written;
    for (const auto& [key, primitive] : primitives) {
        const auto& [object, material] = key;
        const auto [entry, is_new] = materials.try_emplace(material, 0);
        if (is_new) entry->second = add_material(document, textures, scene, scene.materials[material]);
        Json json = write_primitive(document, primitive, light.mesh.points(), scene.materials[material]);
        json["material"] = entry->second;
        written[object].push_back(std::move(json));
    }
    document.use_extension("KHR_materials_unlit");
    document.json["asset"]["extras"]["interflect"] = {
        {"exposure", options.exposure},
        {"COLOR_0",
         "radiance [cd/m^2] * 2^exposure, scaled to at most 1 in its largest channel; of the brightest "
         "texel where there is a base colour texture"},
        {"_IRRADIANCE", "irradiance [lm/m^2] of each channel, linear Rec. 709"}};
    add_nodes(document, scene, written, options.up);
}

}  // namespace interflect::detail
