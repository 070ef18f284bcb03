#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Polygons of one material in local coordinates, shown by any number of instances.
struct Mesh {
    std::string name;                       ///< For messages: "mesh 3 'chair', primitive 0".
    std::vector<Imath::V3d> positions;      ///< Vertex positions.
    std::vector<V2f> texture_coordinates;   ///< One per vertex, as in Scene, or empty.
    std::vector<V2f> lightmap_coordinates;  ///< One per vertex in [0, 1], or empty.
    std::vector<std::uint32_t> indices;     ///< Corners of all faces, counter-clockwise seen from the front.
    std::vector<std::uint32_t> face_sizes;  ///< Number of corners per face, at least 3; empty: all triangles.
    std::uint32_t material = 0;             ///< Index into Model::materials.
    bool back_emits = true;                 ///< Otherwise the backs only reflect and do not emit.
};

/// Mesh placed in the world.
struct MeshInstance {
    std::uint32_t mesh = 0;    ///< Index into Model::meshes.
    Imath::M44d to_world;      ///< For row vectors, p * M as in Imath; to metres. Mirroring keeps the front side.
    std::uint32_t object = 0;  ///< Index into Model::objects.
};

/// Light source that is not a surface, in world coordinates independent of the scene's origin.
struct PlacedLight {
    Luminaire luminaire;           ///< Its position, if it has one, is (0, 0, 0).
    Imath::V3d position{0, 0, 0};  ///< In the world [m].
};

/// Content of a mesh file (glTF, OBJ, PLY, STL, Radiance) as plain data; input of scene_of().
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

/// Converts a model to a scene. All faces are two-sided, because walls are opaque from both sides. Corners with equal
/// positions and coordinates are welded. A pair of triangles becomes one patch if it forms a planar, convex
/// quadrilateral on which texture and lightmap coordinates are each linear. Faces without area are omitted with a
/// warning. Unused materials are kept.
///
/// An object has one lightmap, shared by its meshes with lightmap coordinates; patches of its other meshes have NaN. If
/// such meshes have several transforms (for example, copies of a mesh), they would overlap in the lightmap. Then the
/// object's lightmap coordinates are ignored with a warning.
/// @throws InputError  for an index out of range, a position not finite or too far away, a scene without faces, a scene
///                     too small or too bright, and the faults of scene_faults(). Messages name the mesh.
/// @throws TooManyPatches  for more than options.max_patches patches.
Scene scene_of(Model&& model, const ReadOptions& options);

}  // namespace interflect::inline detail
