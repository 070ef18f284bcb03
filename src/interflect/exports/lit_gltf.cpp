#include "interflect/exports/lit_gltf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "interflect/base/escapes.h"
#include "interflect/base/random.h"
#include "interflect/exports/element_mesh.h"
#include "interflect/exports/gltf_document.h"
#include "interflect/exports/gltf_scene.h"
#include "interflect/geometry/texture_mapping.h"

namespace interflect::inline detail {

namespace {

using Json = GltfDocument::Json;

/// Whether the image of a material stays in the file, so that vertices hold only what it is multiplied by.
bool keeps_texture(const Material& material) {
    return material.reflectance_texture != none && !(channel_sum(material.exitance) > 0);
}

Rgb clamped(const Rgb& colour) {
    return {std::clamp(colour.x, 0.0f, 1.0f), std::clamp(colour.y, 0.0f, 1.0f), std::clamp(colour.z, 0.0f, 1.0f)};
}

/// The vertices of the triangles of one object and material; equal ones are one.
class Primitive {
  public:
    struct Vertex {
        std::uint32_t point;
        Rgb irradiance, colour;
        V2f coordinate{0, 0};

        bool operator==(const Vertex&) const = default;
    };

    void add(const Vertex& vertex) {
        const auto [entry, is_new] = numbers_.try_emplace(vertex, static_cast<std::uint32_t>(vertices_.size()));
        if (is_new) vertices_.push_back(vertex);
        indices_.push_back(entry->second);
    }

    Json write(GltfDocument& document, const std::vector<V3f>& points, bool has_coordinates, int material) const {
        const auto attribute = [&](auto value) {
            std::vector<decltype(value(vertices_[0]))> values;
            for (const Vertex& vertex : vertices_) values.push_back(value(vertex));
            return values;
        };
        Json attributes;
        attributes["POSITION"] = document.add_positions(attribute([&](const Vertex& v) { return points[v.point]; }));
        attributes["COLOR_0"] = document.add_attribute(attribute([](const Vertex& v) { return v.colour; }));
        attributes["_IRRADIANCE"] = document.add_attribute(attribute([](const Vertex& v) { return v.irradiance; }));
        if (has_coordinates)
            attributes["TEXCOORD_0"] = document.add_attribute(attribute([](const Vertex& v) { return v.coordinate; }));
        return {{"attributes", attributes}, {"indices", document.add_indices(indices_)}, {"material", material}};
    }

  private:
    struct Hash {
        std::size_t operator()(const Vertex& v) const {
            std::uint64_t hash = v.point;
            for (const float x : {v.irradiance.x, v.irradiance.y, v.irradiance.z, v.coordinate.x, v.coordinate.y})
                hash = mix(hash ^ std::bit_cast<std::uint32_t>(x), 0);
            return hash;
        }
    };

    std::unordered_map<Vertex, std::uint32_t, Hash> numbers_;
    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> indices_;
};

/// What the vertices of a patch show.
class VertexColours {
  public:
    VertexColours(const Scene& scene, float exposure)
        : scene_(scene), scale_(std::exp2(exposure) / std::numbers::pi_v<float>) {}

    Primitive::Vertex vertex(const Patch& patch, const MeshCorner& corner) const {
        Primitive::Vertex vertex{corner.point, corner.irradiance, Rgb(0), V2f(0)};
        if (keeps_texture(scene_.materials[patch.material])) {
            vertex.colour = clamped(scale_ * corner.irradiance);
            vertex.coordinate = gltf_coordinate(texture_coordinate(scene_, patch, corner.at));
        } else {
            const Rgb reflected = reflectance_at(scene_, patch, corner.at) * corner.irradiance;
            vertex.colour = clamped(scale_ * (exitance_at(scene_, patch, corner.at) + reflected));
        }
        return vertex;
    }

  private:
    const Scene& scene_;
    float scale_;
};

int add_unlit_material(GltfDocument& document, const Scene& scene, const Material& material,
                       std::map<std::uint32_t, int>& textures) {
    Json colour{{"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (keeps_texture(material)) {
        const Rgb& rho = material.reflectance;
        colour["baseColorFactor"] = {rho.x, rho.y, rho.z, 1};
        const auto [entry, is_new] = textures.try_emplace(material.reflectance_texture, 0);
        if (is_new) {
            const Texture& texture = scene.textures[material.reflectance_texture];
            Image image(static_cast<int>(texture.width), static_cast<int>(texture.height));
            image.pixels = texture.texels;
            entry->second = document.add_texture(image, texture.name, true);
        }
        colour["baseColorTexture"] = {{"index", entry->second}};
    }
    return document.add("materials", {{"name", escaped(material.name)},
                                      {"pbrMetallicRoughness", colour},
                                      {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
}

void add_lit_vertices(GltfDocument& document, const Scene& scene, const Solution& solution,
                      const ExportOptions& options) {
    const ElementForest& forest = *solution.forest;
    ElementMesh mesh(scene, forest, solution.irradiance);
    const VertexColours colours(scene, options.exposure);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Primitive> primitives;
    std::vector<MeshTriangle> triangles;
    for (const std::uint32_t leaf : forest.leaves()) {
        triangles.clear();
        mesh.triangulate(leaf, triangles);
        const Patch& patch = scene.patches[forest.patch(leaf)];
        Primitive& primitive = primitives[{patch.object, patch.material}];
        for (const MeshTriangle& triangle : triangles)
            for (const MeshCorner& corner : triangle) primitive.add(colours.vertex(patch, corner));
    }
    std::map<std::uint32_t, int> materials, textures;
    GltfPrimitives written;
    for (const auto& [key, primitive] : primitives) {
        const Material& material = scene.materials[key.second];
        const auto [entry, is_new] = materials.try_emplace(key.second, 0);
        if (is_new) entry->second = add_unlit_material(document, scene, material, textures);
        written[key] = primitive.write(document, mesh.points(), keeps_texture(material), entry->second);
    }
    document.use_extension("KHR_materials_unlit");
    document.json["asset"]["extras"] = {
        {"interflect",
         {{"exposure", options.exposure},
          {"COLOR_0",
           "radiance [cd/m^2] * 2^exposure, clamped to [0, 1]; with a base colour texture what it is "
           "multiplied by: irradiance / pi * 2^exposure"},
          {"_IRRADIANCE", "irradiance [lm/m^2] of each channel, linear Rec. 709"}}}};
    add_nodes(document, scene, written, options.up);
}

}  // namespace

std::vector<ExportedFile> make_glb(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options) {
    GltfDocument document;
    add_lit_vertices(document, scene, solution, options);
    return {{path, document.glb()}};
}

std::vector<ExportedFile> make_gltf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                    const ExportOptions& options) {
    GltfDocument document;
    add_lit_vertices(document, scene, solution, options);
    return {{path, document.gltf()}};
}

}  // namespace interflect::inline detail
