#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/formats/gltf/gltf.h"

namespace interflect::testing_support {

using nlohmann::json;

template <class T>
std::string bytes_of_values(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// Makes small glTF files: JSON that a test may change at will, and a binary chunk.
class GltfBuilder {
  public:
    static constexpr int float_type = 5126, ushort_type = 5123;

    json file = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", json::array()}}}}};
    std::string binary;

    /// Each adds an element and returns its index.
    int add(const char* list, json value) {
        file[list].push_back(std::move(value));
        return static_cast<int>(file[list].size()) - 1;
    }
    int add_view(const std::string& bytes) {
        binary.resize((binary.size() + 3) / 4 * 4);
        const std::size_t offset = binary.size();
        binary += bytes;
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
    }
    int add_accessor(int view, int component_type, std::size_t count, const char* type) {
        return add("accessors",
                   {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
    }
    int add_vectors(const std::vector<V3f>& values) {
        return add_accessor(add_view(bytes_of_values(values)), float_type, values.size(), "VEC3");
    }
    int add_coordinates(const std::vector<V2f>& values) {
        return add_accessor(add_view(bytes_of_values(values)), float_type, values.size(), "VEC2");
    }
    int add_indices(const std::vector<std::uint16_t>& values) {
        return add_accessor(add_view(bytes_of_values(values)), ushort_type, values.size(), "SCALAR");
    }
    int add_mesh(json primitive) { return add("meshes", {{"primitives", {std::move(primitive)}}}); }
    int add_node(json node) {
        const int index = add("nodes", std::move(node));
        file["scenes"][0]["nodes"].push_back(index);
        return index;
    }
    /// Adds a node with the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0), which faces +z, and the given material.
    json& add_triangle(json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}) {
        const int positions = add_vectors({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        const int coordinates = add_coordinates({{0, 0}, {1, 0}, {0, 1}});
        const int mesh = add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", coordinates}}},
                                   {"material", add("materials", std::move(material))}});
        return file["nodes"][static_cast<std::size_t>(add_node({{"mesh", mesh}}))];
    }
    int add_image(const std::string& bytes) {
        const int image = add("images", {{"bufferView", add_view(bytes)}, {"mimeType", "image/png"}});
        return add("textures", {{"source", image}});
    }

    std::string glb() const {
        json complete = file;
        if (!binary.empty() && !complete.contains("buffers")) complete["buffers"] = {{{"byteLength", binary.size()}}};
        std::string text = complete.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string padded = binary;
        padded.resize((padded.size() + 3) / 4 * 4);
        const auto word = [](std::size_t value) {
            return bytes_of_values(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)});
        };
        return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + padded.size()) + word(text.size()) + "JSON" + text +
               word(padded.size()) + std::string("BIN\0", 4) + padded;
    }
    Scene read(const ReadOptions& options = {}) const { return detail::read_gltf_bytes(glb(), "test.glb", options); }
    std::string fault(const ReadOptions& options = {}) const {
        try {
            read(options);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
};

/// Returns world positions of a patch's corners.
inline std::vector<V3f> corners(const Scene& scene, std::size_t patch) {
    std::vector<V3f> result;
    for (int k = 0; k < scene.patches[patch].vertex_count(); ++k)
        result.push_back(V3f(scene.origin) +
                         scene.vertices[scene.patches[patch].vertices[static_cast<std::size_t>(k)]]);
    return result;
}

inline std::vector<std::string> warning_kinds(const Scene& scene) {
    std::vector<std::string> kinds;
    for (const Warnings::Entry& entry : scene.warnings.entries()) kinds.push_back(entry.kind);
    return kinds;
}

}  // namespace interflect::testing_support
