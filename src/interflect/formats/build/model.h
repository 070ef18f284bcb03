#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Faces of one material in local coordinates.
struct Mesh {
    std::string name;  ///< Name for messages.
    std::vector<Imath::V3d> positions;
    std::vector<V2f> texture_coordinates;   ///< Per vertex, as in Scene; or empty.
    std::vector<V2f> lightmap_coordinates;  ///< Per vertex, in [0, 1]; or empty.
    std::vector<Imath::V3d> normals;        ///< Per vertex, any length, 0 if absent; or empty.
    std::vector<std::uint32_t> indices;     ///< Counter-clockwise seen from the front.
    std::vector<std::uint32_t> face_sizes;  ///< Corners per face, >= 3; empty: triangles.
    std::uint32_t material = 0;
    bool back_emits = true;

    /// Origin in a glTF file: the indices of the mesh and its primitive, and of each vertex in the primitive.
    /// A primitive with several colours (COLOR_0) becomes several meshes.
    struct Source {
        std::uint32_t mesh = none, primitive = none;
        std::vector<std::uint32_t> vertices{};
    } source{};
};

struct MeshInstance {
    std::uint32_t mesh = 0;
    Imath::M44d to_world;  ///< Matrix for row vectors; scales to metres. Mirroring keeps the front.
    std::uint32_t object = 0;
    std::uint32_t node = none;  ///< Index in a glTF file.
};

struct PlacedLight {
    Luminaire luminaire;           ///< Luminaire, placed at (0, 0, 0).
    Imath::V3d position{0, 0, 0};  ///< World position [m].
};

/// Content of a file of meshes, before its conversion to a scene.
struct Model {
    std::filesystem::path file;
    std::vector<Mesh> meshes;
    std::vector<MeshInstance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PlacedLight> lights;
    std::vector<std::string> objects{""};  ///< Names, as in Scene::objects.
    std::vector<View> views;               ///< Views in world coordinates [m].
    std::vector<std::string> files;        ///< Files that were read; the first one is `file`.
    Warnings warnings;
};

/// Converts a model to a scene with two-sided faces. Welds corners with equal positions, coordinates and normals.
/// Applies merge_triangle_pairs(). Omits faces without area, with a warning.
///
/// Meshes with lightmap coordinates share their object's lightmap; other patches have NaN. Ignores the coordinates if
/// instances with different transforms share them.
/// @throws InputError for an invalid model, a scene without faces, and scene_faults().
Scene scene_of(Model&& model, const ReadOptions& options);

}  // namespace interflect::detail
