#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "interflect/formats/gltf/data/accessors.h"
#include "interflect/formats/gltf/parts/draco.h"
#include "interflect/formats/gltf/parts/materials.h"

namespace interflect::detail {

struct GltfPose {
    std::vector<double> weights;          ///< Weights of morph targets; the mesh's own if empty.
    std::uint32_t skin = none;            ///< Index of the skin, by which poses are compared.
    std::span<const Imath::M44d> joints;  ///< Matrices that map from the mesh to the world.
};

/// Reads each mesh once per pose.
class GltfMeshes {
  public:
    GltfMeshes(GltfAsset& asset, GltfBuffers& buffers, GltfAccessors& accessors, GltfMaterials& materials);

    std::size_t count() const { return meshes_.size(); }
    /// Returns indices into Model::meshes: one per primitive with faces, or several for primitives with several tints.
    const std::vector<std::uint32_t>& meshes(std::uint32_t index, const GltfPose& pose);

  private:
    struct Vertices;

    /// Triangles with one factor of their reflectance.
    struct TintedFaces {
        Rgb tint{1, 1, 1};
        std::vector<std::uint32_t> indices;
    };

    void add(const GltfValue& primitive, const GltfPose& pose, std::vector<std::uint32_t>& result);
    std::vector<TintedFaces> by_tint(const GltfValue& primitive, std::vector<std::uint32_t> indices,
                                     std::uint64_t vertex_count);
    Mesh mesh_of(const GltfValue& primitive, const Vertices& vertices, const GltfSurface& surface, TintedFaces faces);
    std::string texture_set_of(const GltfValue& primitive);
    Vertices vertices_of(const GltfValue& primitive);
    void read_draco(const GltfValue& primitive, const GltfValue& extension, Vertices& vertices);
    void read_deformation(const GltfValue& primitive, const GltfPose& pose, Vertices& vertices);
    void read_lightmap_coordinates(const GltfElements& set, const std::vector<std::uint32_t>& used, Mesh& mesh);
    GltfElements attribute(const GltfValue& primitive, const char* key, const char* types);
    std::vector<std::uint32_t> corners_of(const GltfValue& primitive, Vertices& vertices);
    /// Counts triangles of the scene. @throws GltfFault for more than max_patches.
    void count_triangles(std::uint64_t count, const GltfValue& primitive);

    GltfAsset& asset_;
    GltfBuffers& buffers_;
    GltfAccessors& accessors_;
    GltfMaterials& materials_;
    std::vector<GltfValue> meshes_;
    std::map<std::tuple<std::uint32_t, std::vector<double>, std::uint32_t>, std::vector<std::uint32_t>> mesh_cache_;
    std::uint64_t triangles_ = 0;
};

}  // namespace interflect::detail
