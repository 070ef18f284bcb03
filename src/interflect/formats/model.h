#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "interflect/load.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Polygons of one material in local coordinates.
struct Mesh {
    std::string name;  ///< For messages: "mesh 3 'chair', primitive 0".
    std::vector<Imath::V3d> positions;
    std::vector<V2f> texture_coordinates;   ///< Per vertex, as in Scene; or empty.
    std::vector<V2f> lightmap_coordinates;  ///< Per vertex, in [0, 1]; or empty.
    std::vector<Imath::V3d> normals;        ///< Per vertex, of any length, (0, 0, 0) for none; or empty.
    std::vector<std::uint32_t> indices;     ///< Counter-clockwise seen from the front.
    std::vector<std::uint32_t> face_sizes;  ///< Corners per face, >= 3; empty: all triangles.
    std::uint32_t material = 0;             ///< Index into Model::materials.
    bool back_emits = true;                 ///< If false, backs reflect only.
};

struct MeshInstance {
    std::uint32_t mesh = 0;    ///< Index into Model::meshes.
    Imath::M44d to_world;      ///< For row vectors, p * M; to metres. Mirroring keeps the front.
    std::uint32_t object = 0;  ///< Index into Model::objects.
};

/// Light that is not a surface, independent of the scene's origin.
struct PlacedLight {
    Luminaire luminaire;           ///< At (0, 0, 0).
    Imath::V3d position{0, 0, 0};  ///< In the world [m].
};

/// Content of a glTF, OBJ, PLY, STL or Radiance file; input of scene_of().
struct Model {
    std::filesystem::path file;
    std::vector<Mesh> meshes;
    std::vector<MeshInstance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PlacedLight> lights;
    std::vector<std::string> objects{""};  ///< As in Scene::objects.
    std::vector<View> views;               ///< In the world [m].
    std::vector<std::string> files;        ///< All files read, the model's own first.
    Warnings warnings;
};

/// Converts a model to a scene. All faces are two-sided, since walls are opaque from both sides. Corners with equal
/// positions and coordinates are welded. Two triangles become one patch if they form a planar, convex quadrilateral
/// with linear texture and lightmap coordinates. Faces without area are omitted with a warning. Unused materials are
/// kept.
///
/// Meshes with lightmap coordinates share the lightmap of their object; other patches have NaN. If their instances
/// differ in transform, they would overlap, and the object's coordinates are ignored with a warning.
/// @throws InputError  naming the mesh, for indices out of range, invalid or too distant positions, scenes without
///                     faces, too small or too bright, and scene_faults(). @throws TooManyPatches
Scene scene_of(Model&& model, const ReadOptions& options);

}  // namespace interflect::detail
