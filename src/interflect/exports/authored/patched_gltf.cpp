#include "interflect/exports/authored/patched_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "interflect/exports/authored/authored_charts.h"
#include "interflect/exports/authored/lit_materials.h"
#include "interflect/exports/authored/moved_texels.h"
#include "interflect/exports/authored/vertex_splits.h"
#include "interflect/exports/charts/atlas.h"
#include "interflect/exports/gltf/lightmap_images.h"
#include "interflect/exports/mesh/shown_patches.h"

namespace interflect::detail {

namespace {

constexpr const char* khr_draco = "KHR_draco_mesh_compression";

// Component types of glTF accessors. Signed types are one less than unsigned ones; the other types have 4 bytes.
constexpr int unsigned_byte = 5121, unsigned_short = 5123, single_precision = 5126;

std::size_t component_bytes(int component_type) {
    return component_type <= unsigned_byte ? 1 : component_type <= unsigned_short ? 2 : 4;
}

void remove_extension(Json& owner, const char* name) {
    if (!owner.contains("extensions")) return;
    owner["extensions"].erase(name);
    if (owner["extensions"].empty()) owner.erase("extensions");
}

/// Writes meshes with lightmap coordinates.
class LitMeshes {
  public:
    LitMeshes(GltfDocument& document, SourceGltf& source, const AuthoredCharts& authored, const BakedImages& baked,
              LitMaterials& materials)
        : document_(document),
          source_(source),
          authored_(authored),
          baked_(baked),
          materials_(materials),
          meshes_(document.json["meshes"]) {
        keep_unlit();
    }

    void light(const AuthoredObject& object) {
        const AuthoredShape& shape = authored_.shapes[object.shape];
        if (shape.charts.empty()) return;  // its density is 0, or its triangles have no area
        const std::uint32_t number = authored_.model.meshes[shape.meshes.front()].source.mesh;
        Json mesh = meshes_[number];
        std::vector<bool> is_lit(mesh["primitives"].size(), false);
        for (const std::uint32_t index : shape.meshes) {
            const std::uint32_t primitive = authored_.model.meshes[index].source.primitive;
            if (!is_lit[primitive]) light(mesh["primitives"][primitive], object, primitive);
            is_lit[primitive] = true;
        }
        if (taken_meshes_.insert(number).second)
            document_.json["meshes"][number] = std::move(mesh);
        else
            document_.json["nodes"][object.node]["mesh"] = document_.add("meshes", std::move(mesh));
    }

  private:
    using Key = std::pair<std::uint32_t, std::uint32_t>;  // shape and primitive

    /// Protects the meshes of nodes without a lightmap, and the materials of primitives without one, from changes.
    void keep_unlit() {
        std::set<std::pair<std::uint32_t, std::uint32_t>> lit;  // mesh and primitive of the file
        for (const AuthoredShape& shape : authored_.shapes)
            for (const LightmapChart& chart : shape.charts)
                for (const FlatPatch& flat : chart.patches) {
                    const auto& source = authored_.model.meshes[shape.triangles[flat.patch].mesh].source;
                    lit.emplace(source.mesh, source.primitive);
                }
        std::set<std::uint32_t> lit_nodes;
        for (const AuthoredObject& object : authored_.objects)
            if (!authored_.shapes[object.shape].charts.empty()) lit_nodes.insert(object.node);
        const Json& nodes = document_.json["nodes"];
        for (std::uint32_t i = 0; i < nodes.size(); ++i)
            if (nodes[i].contains("mesh") && !lit_nodes.contains(i))
                taken_meshes_.insert(nodes[i]["mesh"].get<std::uint32_t>());
        for (std::uint32_t m = 0; m < meshes_.size(); ++m)
            for (std::uint32_t k = 0; k < meshes_[m]["primitives"].size(); ++k)
                if (taken_meshes_.contains(m) || !lit.contains({m, k})) materials_.keep(meshes_[m]["primitives"][k]);
    }

    void light(Json& primitive, const AuthoredObject& object, std::uint32_t number) {
        const Key key{object.shape, number};
        if (!split_primitives_.contains(key)) split(primitive, key);
        const auto has_chart = [](const SplitVertices::Place& place) { return place.chart != none; };
        if (std::none_of(vertices_[key].places.begin(), vertices_[key].places.end(), has_chart)) return;
        primitive = split_primitives_[key];
        const std::vector<LightmapChart>& charts = authored_.charts;
        std::vector<V2f> coordinates;
        for (const SplitVertices::Place& place : vertices_[key].places) {
            coordinates.emplace_back(0.0f, 0.0f);
            if (place.chart == none) continue;
            const LightmapChart& chart = charts[object.first_chart + place.chart];
            coordinates.back() = chart.coordinate(chart.patches[place.patch].corners[place.corner], baked_.images);
        }
        const int accessor = document_.add_attribute(coordinates);
        Json& attributes = primitive["attributes"];
        for (int set = 0; set <= materials_.set(); ++set)  // glTF allows no gaps
            if (const std::string name = fmt::format("TEXCOORD_{}", set);
                set == materials_.set() || !attributes.contains(name))
                attributes[name] = accessor;
        materials_.light(primitive, charts[object.first_chart].page);
    }

    /// Copies vertices where charts meet.
    void split(const Json& primitive, const Key& key) {
        const auto& [shape, number] = key;
        const std::uint32_t position = primitive["attributes"]["POSITION"];
        const std::uint32_t count = document_.json["accessors"][position]["count"];
        SplitVertices& vertices = vertices_[key];
        vertices = split_vertices(authored_.model, authored_.shapes[shape], number, count);
        Json& result = split_primitives_[key] = primitive;
        if (vertices.copied.empty()) return;
        const bool is_compressed = primitive.contains("extensions") && primitive["extensions"].contains(khr_draco);
        if (is_compressed) decompress(result, shape, number, vertices);
        const auto copy_all = [&](Json& attributes, const Json& compressed) {
            for (auto& [name, accessor] : attributes.items())
                if (!compressed.contains(name)) accessor = with_copies(source_.elements(accessor), accessor, vertices);
        };
        copy_all(result["attributes"],
                 is_compressed ? primitive["extensions"][khr_draco]["attributes"] : Json::object());
        if (result.contains("targets"))
            for (Json& target : result["targets"]) copy_all(target, Json::object());
        result["indices"] = document_.add_indices(vertices.corners);
        result.erase("mode");  // triangles
    }

    /// Replaces compressed attributes by ones in single precision, or whole numbers for joints.
    void decompress(Json& primitive, std::uint32_t shape, std::uint32_t number, const SplitVertices& vertices) {
        const std::uint32_t mesh = authored_.model.meshes[authored_.shapes[shape].meshes.front()].source.mesh;
        for (auto& [name, values] : source_.decompressed(mesh, number)) {
            std::vector<std::uint16_t> joints;
            const auto components = static_cast<std::size_t>(values.components);
            GltfElements elements{.first = reinterpret_cast<const char*>(values.values.data()),
                                  .stride = components * sizeof(float),
                                  .count = values.values.size() / components,
                                  .component_type = single_precision,
                                  .components = values.components};
            if (name.starts_with("JOINTS_")) {
                for (const float joint : values.values)
                    joints.push_back(joint > 0 ? static_cast<std::uint16_t>(std::min(joint, 65535.0f)) : 0);
                elements.first = reinterpret_cast<const char*>(joints.data());
                elements.stride = components * sizeof(std::uint16_t);
                elements.component_type = unsigned_short;
            }
            Json& accessor = primitive["attributes"][name];
            accessor = with_copies(elements, accessor, vertices);
        }
        remove_extension(primitive, khr_draco);
    }

    /// Adds an accessor with further copies of some elements.
    /// @param described  Index of the accessor with the other properties.
    int with_copies(const GltfElements& elements, std::uint32_t described, const SplitVertices& vertices) {
        const std::vector<std::uint32_t>& copied = vertices.copied;
        const std::size_t count = vertices.places.size() - copied.size();
        if (elements.count != count)
            throw GltfFault(fmt::format("an attribute has {} elements for {} vertices", elements.count, count));
        const std::size_t size =
            component_bytes(elements.component_type) * static_cast<std::size_t>(elements.components);
        constexpr std::size_t alignment = 4;
        const std::size_t stride = (size + alignment - 1) / alignment * alignment;
        std::string bytes((elements.count + copied.size()) * stride, '\0');
        const auto copy = [&](std::uint64_t from, std::size_t to) {
            if (elements.first) bytes.replace(to * stride, size, elements.first + from * elements.stride, size);
        };
        for (std::uint64_t i = 0; i < elements.count; ++i) copy(i, i);
        for (std::size_t i = 0; i < copied.size(); ++i) copy(copied[i], elements.count + i);
        Json json = document_.json["accessors"].at(described);
        for (const char* place : {"bufferView", "byteOffset", "sparse"}) json.erase(place);
        if (!elements.normalized) json.erase("normalized");
        json["componentType"] = elements.component_type;
        json["count"] = elements.count + copied.size();
        return document_.add_elements(std::move(json), bytes, stride);
    }

    GltfDocument& document_;
    SourceGltf& source_;
    const AuthoredCharts& authored_;
    const BakedImages& baked_;
    LitMaterials& materials_;
    const Json meshes_;                     // meshes of the file before changes
    std::set<std::uint32_t> taken_meshes_;  // meshes that must not change, because a node already uses them
    std::map<Key, SplitVertices> vertices_;
    std::map<Key, Json> split_primitives_;
};

/// Warns about objects whose lightmap contains one side although the other one is visible and lit.
void warn_of_backs(const Json& file, const AuthoredCharts& authored, const TexelMover& mover, Warnings& warnings) {
    const auto shows_back = [&](std::uint32_t mesh) {
        const auto& [number, primitive, vertices] = authored.model.meshes[mesh].source;
        const Json& json = file.at("meshes").at(number).at("primitives").at(primitive);
        return json.contains("material") &&
               file.at("materials").at(json["material"].get<std::size_t>()).value("doubleSided", false);
    };
    for (std::size_t i = 0; i < authored.objects.size(); ++i) {
        const std::vector<std::uint32_t>& meshes = authored.shapes[authored.objects[i].shape].meshes;
        if (mover.is_lit_on_both_sides(i) && std::any_of(meshes.begin(), meshes.end(), shows_back))
            warnings.add("lightmap-sides", "the object is lit on both sides: its lightmap has the light of its front",
                         authored.model.objects[authored.objects[i].object]);
    }
}

/// Removes an extension from the lists of used and required ones.
void unlist_extension(Json& file, const char* extension) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!file.contains(list)) continue;
        Json& names = file[list];
        names.erase(std::remove(names.begin(), names.end(), extension), names.end());
        if (names.empty()) file.erase(list);
    }
}

void remove_lights(Json& file) {
    for (const char* name : {"KHR_lights_punctual", "EXT_lights_ies"}) {
        remove_extension(file, name);
        if (file.contains("nodes"))
            for (Json& node : file["nodes"]) remove_extension(node, name);
        unlist_extension(file, name);
    }
}

bool uses_draco(const Json& file) {
    for (const Json& mesh : file.at("meshes"))
        for (const Json& primitive : mesh.at("primitives"))
            if (primitive.contains("extensions") && primitive["extensions"].contains(khr_draco)) return true;
    return false;
}

}  // namespace

std::vector<ExportedFile> add_lightmap(GltfDocument& document, SourceGltf& source, const std::filesystem::path& path,
                                       const Scene& scene, const Solution& solution, const ExportOptions& options,
                                       const EarlierLightmap* earlier) {
    const LightmapOptions& chosen = *options.lightmap;
    Warnings ignored;
    Warnings& warnings = options.warnings ? *options.warnings : ignored;
    AuthoredCharts authored = authored_charts(source.model(), authored_densities(document.json), chosen, warnings);
    if (authored.charts.empty() && !authored.objects.empty())
        throw InputError("no surface gets a lightmap: the density of each is 0, or its triangles have no area");
    PatchVisibility visibility;
    std::optional<TexelMover> mover;  // empty for images without light
    if (chosen.content != LightmapContent::density) {
        visibility = patch_visibility(scene, solution);
        mover.emplace(authored, scene, visibility);
    }
    const PackCharts pack = [&](std::vector<LightmapChart>& charts) {
        return pack_groups(charts, authored.first_charts(), chosen.gutter, chosen.max_size);
    };
    const MoveTexels move = [&](std::size_t chart, std::span<TexelPlace> places) { mover->move(chart, places); };
    const BakedImages baked = bake_charts(authored.charts, pack, move, scene, solution, options, earlier);
    if (mover) warn_of_backs(document.json, authored, *mover, warnings);

    LightmapImages images = add_lightmap_images(document, path, baked, solution.group_names, options, earlier);
    LitMaterials materials(document, images);
    LitMeshes meshes(document, source, authored, baked, materials);
    for (const AuthoredObject& object : authored.objects) meshes.light(object);
    if (!uses_draco(document.json)) unlist_extension(document.json, khr_draco);
    if (!chosen.keep_lights) remove_lights(document.json);
    return std::move(images.files);
}

}  // namespace interflect::detail
