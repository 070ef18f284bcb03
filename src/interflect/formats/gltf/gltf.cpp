#include "interflect/formats/gltf/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <new>
#include <span>
#include <string_view>

#include "interflect/core.h"
#include "interflect/formats/gltf/baked_light.h"
#include "interflect/formats/gltf/parts/lights.h"
#include "interflect/formats/gltf/parts/meshes.h"
#include "interflect/formats/gltf/parts/nodes.h"
#include "interflect/formats/text/json_text.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

using Imath::M44d;

constexpr std::string_view known_extensions[] = {
    "EXT_lights_ies",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
};

/// Extensions that do not affect surfaces, base colours and lights, so that files may require them.
constexpr std::string_view ignorable_extensions[] = {
    "AGI_articulations",      "CESIUM_primitive_outline",
    "EXT_feature_metadata",   "EXT_instance_features",
    "EXT_mesh_features",      "EXT_structural_metadata",
    "KHR_animation_pointer",  "KHR_audio",
    "KHR_interactivity",      "KHR_materials_dispersion",
    "KHR_materials_variants", "KHR_node_hoverability",
    "KHR_node_selectability", "KHR_xmp",
    "KHR_xmp_json_ld",        "MSFT_lod",
};

bool is_in(std::span<const std::string_view> extensions, const std::string& extension) {
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

void require_readable(GltfAsset& asset) {
    const GltfValue& root = asset.root();
    const std::string version = root.object("asset").text("version");
    if (!version.starts_with("2.") || root.object("asset").text("minVersion", "2.0") != "2.0")
        root.fail(fmt::format("asset.version is '{}', expected 2.0", version));
    std::string unknown;
    for (const std::string& name : root.texts("extensionsRequired"))
        if (!is_in(known_extensions, name) && !is_in(ignorable_extensions, name))
            unknown += (unknown.empty() ? "" : ", ") + name;
    if (!unknown.empty()) root.fail(fmt::format("it requires extensions that are not read: {}", unknown));
    for (const std::string& name : root.texts("extensionsUsed"))
        if (!is_in(known_extensions, name))
            asset.warn("extension", fmt::format("the extension {} is ignored", name), "extensionsUsed");
    if (root.has("animations")) asset.warn("animation", "animations are ignored", "animations");
}

class SceneReader {
  public:
    SceneReader(GltfAsset& asset, const GltfParts& parts)
        : asset_(asset),
          buffers_(asset, parts),
          accessors_(asset, buffers_),
          images_(asset, buffers_),
          materials_(asset, images_),
          meshes_(asset, buffers_, accessors_, materials_),
          nodes_(asset),
          lights_(asset, buffers_),
          skins_(asset.root().objects("skins")) {}

    void read() {
        for (const GltfNode& node : nodes_.in_scene()) {
            const std::uint32_t mesh = node.value->index("mesh", meshes_.count());
            const std::uint32_t object = mesh != none || lights_.has_light(node) ? object_of(node) : 0;
            if (mesh != none) show(node, mesh, object);
            lights_.add(node, object);
        }
        materials_.warn_of_lost_reflection();
    }

  private:
    std::uint32_t object_of(const GltfNode& node) {
        std::vector<std::string>& objects = asset_.model.objects;
        const auto [entry, is_new] = object_index_.try_emplace(node.dotted, static_cast<std::uint32_t>(objects.size()));
        if (is_new) objects.push_back(node.dotted);
        return entry->second;
    }

    void show(const GltfNode& node, std::uint32_t mesh, std::uint32_t object) {
        GltfPose pose;
        pose.weights = node.value->numbers("weights");
        pose.skin = node.value->index("skin", skins_.size());
        if (pose.skin != none) pose.joints = joints_of(pose.skin);
        const std::vector<std::uint32_t>& primitives = meshes_.meshes(mesh, pose);
        if (primitives.empty()) return;
        std::uint64_t faces = 0;
        for (const std::uint32_t primitive : primitives) faces += asset_.model.meshes[primitive].indices.size() / 3;
        const std::vector<M44d> places = places_of(node, std::max<std::uint64_t>(faces, primitives.size()));
        // A skinned mesh ignores the node's transform.
        for (const M44d& place : places)
            for (const std::uint32_t primitive : primitives)
                asset_.model.instances.push_back({primitive, pose.skin != none ? M44d() : place, object, node.index});
    }

    void require_room(const GltfValue& node, std::uint64_t copies, std::uint64_t faces) {
        faces_ += static_cast<double>(copies) * static_cast<double>(faces);
        if (faces_ > static_cast<double>(asset_.options().max_patches))
            throw GltfFault(
                fmt::format("{}: its {} instances of {} faces would give more than {} patches (max_patches)",
                            node.place(), copies, faces, asset_.options().max_patches),
                "max_patches");
    }

    /// Returns the transforms of the copies of a node (EXT_mesh_gpu_instancing), or the node's own transform.
    std::vector<M44d> places_of(const GltfNode& node, std::uint64_t faces) {
        const GltfValue extension = node.value->extension("EXT_mesh_gpu_instancing");
        if (!extension.exists()) {
            require_room(*node.value, 1, faces);
            return {node.to_world};
        }
        const GltfValue attributes = extension.object("attributes");
        const auto open = [&](const char* key, const char* type) {
            const std::uint32_t accessor = attributes.index(key, accessors_.count());
            return accessor == none ? GltfElements() : accessors_.elements(accessor, type, attributes);
        };
        const GltfElements moves = open("TRANSLATION", "VEC3"), turns = open("ROTATION", "VEC4"),
                           scales = open("SCALE", "VEC3");
        const std::uint64_t count = std::max({moves.count, turns.count, scales.count});
        for (const GltfElements& values : {moves, turns, scales})
            if (values.first && values.count != count) attributes.fail("its attributes differ in their counts");
        require_room(*node.value, count, faces);
        std::vector<M44d> places;
        const auto at = [](const GltfElements& values, std::uint64_t i, double otherwise) {
            if (!values.first) return Imath::V3d(otherwise);
            return Imath::V3d(values.number(i, 0), values.number(i, 1), values.number(i, 2));
        };
        for (std::uint64_t i = 0; i < count; ++i) {
            std::array<double, 4> turn = {0, 0, 0, 1};
            for (int c = 0; turns.first && c < 4; ++c) turn[static_cast<std::size_t>(c)] = turns.number(i, c);
            const M44d place = gltf_transform(at(scales, i, 1), turn, at(moves, i, 0), extension) * node.to_world;
            if (places.empty() || place != places.back()) places.push_back(place);
        }
        if (places.size() < count)
            asset_.warn("instances", "copies of a mesh that follow another one at the same place are left out",
                        extension.place());
        return places;
    }

    /// Returns the matrices of a skin's joints, which map from the mesh to the world.
    const std::vector<M44d>& joints_of(std::uint32_t index) {
        const auto [entry, is_new] = joints_.try_emplace(index);
        std::vector<M44d>& result = entry->second;
        if (!is_new) return result;
        const GltfValue& skin = skins_[index];
        for (const std::uint32_t joint : skin.indices("joints", nodes_.count()))
            result.push_back(nodes_.to_world(joint));
        const std::uint32_t inverse = skin.index("inverseBindMatrices", accessors_.count());
        if (inverse == none) return result;
        const GltfElements matrices = accessors_.elements(inverse, "MAT4", skin);
        if (matrices.count < result.size()) skin.fail("it has fewer inverseBindMatrices than joints");
        for (std::size_t i = 0; i < result.size(); ++i) {
            M44d bind;
            for (int k = 0; k < 16; ++k) bind[k / 4][k % 4] = matrices.number(i, k);
            result[i] = bind * result[i];
        }
        return result;
    }

    GltfAsset& asset_;
    GltfBuffers buffers_;
    GltfAccessors accessors_;
    GltfImages images_;
    GltfMaterials materials_;
    GltfMeshes meshes_;
    GltfNodes nodes_;
    GltfLights lights_;
    std::vector<GltfValue> skins_;
    double faces_ = 0;
    std::map<std::uint32_t, std::vector<M44d>> joints_;  // keys: skins
    std::map<std::string, std::uint32_t> object_index_{{"", 0}};
};

Model model_of(std::string_view bytes, const fs::path& path, const ReadOptions& options) {
    const GltfParts parts = gltf_parts(bytes);
    if (parts.json.size() > options.max_json_bytes)
        throw GltfFault(fmt::format("its JSON has {} bytes; at most {} are read (max_json_bytes)", parts.json.size(),
                                    options.max_json_bytes));
    nlohmann::json json = parse_json(parts.json, path);
    if (!json.is_object()) throw GltfFault("its JSON is not an object");
    const bool is_baked = remove_baked_light(json);
    GltfAsset asset(path, options, json);
    if (is_baked)
        asset.warn("baked light",
                   "Interflect has baked this file: its lightmaps are ignored, and light sources that the bake removed "
                   "are missing; expected the file that was baked",
                   "asset.extras.interflect");
    require_readable(asset);
    SceneReader(asset, parts).read();
    return std::move(asset.model);
}

}  // namespace

Model read_gltf_model(std::string_view bytes, const fs::path& path, const ReadOptions& options) {
    try {
        return model_of(bytes, path, options);
    } catch (const GltfFault& fault) {
        throw InputError(Fault{.text = fault.what(), .setting = fault.setting, .file = path});
    }
}

Scene read_gltf_bytes(std::string_view bytes, const fs::path& path, const ReadOptions& options) {
    return scene_of(read_gltf_model(bytes, path, options), options);
}

Scene read_gltf(const fs::path& path, const ReadOptions& options) {
    return read_gltf_bytes(read_bytes(path, options.max_model_bytes), path, options);
}

}  // namespace interflect::detail
