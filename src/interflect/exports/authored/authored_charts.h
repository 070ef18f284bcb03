#pragma once

#include <ImathMatrix.h>

#include <cstdint>
#include <map>
#include <vector>

#include "interflect/exports/charts/charts.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/formats/build/model.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// The mesh of a node, scaled as in the node. Each triangle of the file is a patch.
struct AuthoredShape {
    /// Place of a patch in the file.
    struct Triangle {
        std::uint32_t mesh;   ///< Index into Model::meshes.
        std::uint32_t first;  ///< Index of its first corner in Mesh::indices.
    };

    std::vector<std::uint32_t> meshes;  ///< Indices into Model::meshes, the primitives of one mesh of the file.
    PerPatch<Triangle> triangles;       ///< Triangles without area are left out.
    PerPatch<std::uint32_t> parts;      ///< Number of each patch's part; parts have no common corners.
    std::vector<LightmapChart> charts;
};

/// A node that shows a mesh.
struct AuthoredObject {
    std::uint32_t node, shape;
    std::uint32_t object;       ///< Index into Model::objects.
    std::uint32_t first_chart;  ///< Index of its first chart; the others follow in the order of its shape.
    Imath::M44d to_world;
};

/// Charts of a glTF file that depend on its geometry alone. Nodes that show one mesh have copies of the same charts.
struct AuthoredCharts {
    Model model;
    std::vector<AuthoredShape> shapes;
    std::vector<AuthoredObject> objects;
    std::vector<LightmapChart> charts;  ///< Charts of all objects.

    std::vector<std::uint32_t> first_charts() const;  ///< AuthoredObject::first_chart of each object.
    /// Returns the corners of a patch in the world [m].
    std::array<Imath::V3d, 3> corners(const AuthoredObject& object, PatchIndex patch) const;
};

/// Densities of texels in a glTF file: the number `extras.texels_per_metre` of nodes and materials, which is a custom
/// property in Blender. LightmapOptions::densities take precedence over nodes, and nodes over materials.
struct AuthoredDensities {
    std::map<std::uint32_t, float> nodes;
    std::vector<TexelDensity> materials;  ///< Their patterns are the names of materials.
};
/// @throws InputError for a density that is not a number from 0 up.
AuthoredDensities authored_densities(const Json& file);

/// @param warnings  Receives the warnings of make_charts(), and one for each node without a lightmap
///                  (EXT_mesh_gpu_instancing).
AuthoredCharts authored_charts(Model model, const AuthoredDensities& densities, const LightmapOptions& options,
                               Warnings& warnings);

}  // namespace interflect::detail
