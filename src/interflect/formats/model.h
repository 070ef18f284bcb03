#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "interflect/read_options.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Polygons of one material in their own coordinates. Any number of instances may show it.
struct Mesh {
    std::string name;                       ///< For messages: "mesh 3 'chair', primitive 0".
    std::vector<Imath::V3d> positions;      ///< Of the vertices.
    std::vector<V2f> texture_coordinates;   ///< One for each vertex, as Scene has them, or empty.
    std::vector<V2f> lightmap_coordinates;  ///< Likewise; in [0, 1].
    std::vector<Imath::V3d> normals;        ///< One for each vertex, of any length; (0, 0, 0) for none. Or empty.
    std::vector<std::uint32_t> indices;     ///< Of the corners of all faces, counter-clockwise seen from the front.
    std::vector<std::uint32_t> face_sizes;  ///< How many corners each face has, at least 3; empty: triangles alone.
    std::uint32_t material = 0;             ///< Index into Model::materials.
    bool back_emits = true;                 ///< Else the backs of its faces reflect as the fronts do, but emit nothing.
};

/// A mesh placed in the world.
struct MeshInstance {
    std::uint32_t mesh = 0;    ///< Index into Model::meshes.
    Imath::M44d to_world;      ///< Of row vectors, p * M as Imath has it; to metres. It may mirror: fronts stay fronts.
    std::uint32_t object = 0;  ///< Index into Model::objects.
};

/// A source of light that is not a surface, placed in the world whatever the scene's origin.
struct PlacedLight {
    Luminaire luminaire;           ///< Its position, if it has one, is (0, 0, 0).
    Imath::V3d position{0, 0, 0};  ///< In the world [m].
};

/// What a file of meshes holds (glTF, OBJ, PLY, STL, Radiance): plain data, which scene_of() makes a Scene of.
struct Model {
    std::filesystem::path file;
    std::vector<Mesh> meshes;
    std::vector<MeshInstance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PlacedLight> lights;
    std::vector<std::string> objects{""};  ///< As Scene::objects.
    std::vector<View> views;               ///< In the world [m].
    std::vector<std::string> files;        ///< Every file that was read, the model's own first.
    Warnings warnings;
};

/// The scene that a model describes. All faces are two-sided, since light does not pass through walls whatever side
/// they are seen from. Corners that coincide, their coordinates included, are welded; pairs of triangles that form a
/// planar, convex quadrilateral (and over which the coordinates in textures and in the lightmap are those of one linear
/// map each) become one patch. Faces without area are left out with a warning. Materials that no face shows are kept.
///
/// An object has one lightmap, in which its meshes with lightmap coordinates lie side by side; patches of its other
/// meshes have none (NaN). Where such meshes are in several places, as copies of one mesh are, they would lie on each
/// other: then the object's lightmap coordinates are ignored with a warning.
/// @throws InputError  for an index out of range, a position that is not finite or too far away, a scene without a
///         face, or one that is too small or too bright, and as scene_faults() has it; TooManyPatches where it has more
///         than options.max_patches. Messages name the mesh.
Scene scene_of(Model&& model, const ReadOptions& options);

}  // namespace interflect::inline detail
