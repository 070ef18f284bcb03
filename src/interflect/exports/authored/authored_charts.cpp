#include "interflect/exports/authored/authored_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "interflect/geometry/search/disjoint_sets.h"
#include "interflect/geometry/search/vertex_weld.h"

namespace interflect::detail {

namespace {

using Imath::M44d;
using Imath::V3d;

V3d to_world(const V3d& x, const M44d& matrix) {
    V3d result;
    matrix.multVecMatrix(x, result);
    return result;
}

/// Returns scalar products of the transformed axes. Transforms with equal products differ by a rotation or reflection.
std::array<double, 6> metric_of(const M44d& m) {
    const V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    return {x.dot(x), y.dot(y), z.dot(z), x.dot(y), y.dot(z), z.dot(x)};
}

bool are_alike(const std::array<double, 6>& a, const std::array<double, 6>& b) {
    constexpr double rounding = 1e-4;
    const double size = std::max({a[0], a[1], a[2]});
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::abs(a[i] - b[i]) > rounding * size) return false;
    return true;
}

/// Adds the triangles of a mesh to a scene, in which they are relative to `origin`.
void add_triangles(const Model& model, std::uint32_t index, const M44d& matrix, const V3d& origin, VertexWeld& weld,
                   Scene& scene, AuthoredShape& shape) {
    const Mesh& mesh = model.meshes[index];
    std::vector<std::uint32_t> vertices;
    vertices.reserve(mesh.positions.size());
    const M44d normals = matrix.inverse().transposed();
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        VertexCoordinates coordinates;
        if (!mesh.lightmap_coordinates.empty()) coordinates.lightmap = mesh.lightmap_coordinates[v];
        if (!mesh.normals.empty()) {
            V3d normal;
            normals.multDirMatrix(mesh.normals[v], normal);
            coordinates.normal = welded_normal(normal);
        }
        vertices.push_back(weld.vertex(V3f(to_world(mesh.positions[v], matrix) - origin), coordinates));
    }
    for (std::uint32_t first = 0; first < mesh.indices.size(); first += 3) {
        Patch patch;
        for (std::uint32_t c = 0; c < 3; ++c) patch.vertices[c] = vertices[mesh.indices[first + c]];
        patch.material = mesh.material;
        patch.other_side = PatchIndex(none);
        const V3f& a = scene.vertices[patch.vertices[0]];
        const V3f u = scene.vertices[patch.vertices[1]] - a, v = scene.vertices[patch.vertices[2]] - a;
        constexpr float thin = 1e-6f;  // relative height below which rounding determines the plane
        if (!(u.cross(v).length() > thin * std::max({u.length2(), v.length2(), (v - u).length2()}))) continue;
        scene.patches.push_back(patch);
        shape.triangles.push_back({index, first});
    }
}

constexpr const char* density_property = "texels_per_metre";

/// Numbers the connected components of the patches.
PerPatch<std::uint32_t> parts_of(const Scene& scene) {
    Scene points;  // vertices that are joined in spite of different normals and coordinates
    VertexWeld weld(points);
    std::vector<std::uint32_t> point_of;
    point_of.reserve(scene.vertices.size());
    for (const V3f& x : scene.vertices) point_of.push_back(weld.vertex(x));
    DisjointSets sets(points.vertices.size());
    for (const Patch& patch : scene.patches)
        for (int c = 1; c < patch.vertex_count(); ++c)
            sets.unite(point_of[patch.vertices[0]], point_of[patch.vertices[c]]);
    PerPatch<std::uint32_t> parts;
    for (const Patch& patch : scene.patches) parts.push_back(sets.find(point_of[patch.vertices[0]]));
    return parts;
}

/// @param scene  Contains the materials; the rest is replaced.
AuthoredShape shape_of(const Model& model, std::vector<std::uint32_t> meshes, const M44d& matrix,
                       const std::string& object, const LightmapOptions& options, Scene& scene, Warnings& warnings) {
    AuthoredShape shape;
    std::vector<Material> materials = std::move(scene.materials);
    scene = Scene();
    scene.materials = std::move(materials);
    scene.objects = {object};
    VertexWeld weld(scene);
    const V3d origin = to_world(model.meshes[meshes.front()].positions.front(), matrix);
    for (const std::uint32_t mesh : meshes) add_triangles(model, mesh, matrix, origin, weld, scene, shape);
    shape.meshes = std::move(meshes);
    shape.parts = parts_of(scene);
    std::vector<bool> is_lit;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) is_lit.push_back(density_of(scene, p, options) > 0);
    shape.charts = make_charts(scene, std::move(is_lit), options, &warnings);
    return shape;
}

std::vector<bool> matching_densities(const std::string& object, const LightmapOptions& options) {
    std::vector<bool> matching;
    for (const TexelDensity& density : options.densities) matching.push_back(matches_object(density.pattern, object));
    return matching;
}

/// The primitives of one node at one place.
struct ShownMesh {
    const MeshInstance* first;
    std::vector<std::uint32_t> meshes;
};

std::vector<ShownMesh> shown_meshes(const Model& model, Warnings& warnings) {
    std::vector<ShownMesh> shown;
    std::map<std::uint32_t, int> place_count;  // number of places of each node
    for (const MeshInstance& instance : model.instances) {
        const bool continues = !shown.empty() && shown.back().first->node == instance.node &&
                               shown.back().first->to_world == instance.to_world;
        if (!continues) {
            shown.push_back({&instance, {}});
            ++place_count[instance.node];
        }
        shown.back().meshes.push_back(instance.mesh);
    }
    std::erase_if(shown, [&](const ShownMesh& one) {
        const bool is_copied = place_count[one.first->node] > 1;
        if (is_copied)
            warnings.add("lightmap-instances",
                         "copies by EXT_mesh_gpu_instancing get no lightmap: they have one set of coordinates",
                         model.objects[one.first->object]);
        return is_copied;
    });
    return shown;
}

}  // namespace

std::vector<std::uint32_t> AuthoredCharts::first_charts() const {
    std::vector<std::uint32_t> first;
    for (const AuthoredObject& object : objects) first.push_back(object.first_chart);
    return first;
}

std::array<V3d, 3> AuthoredCharts::corners(const AuthoredObject& object, PatchIndex patch) const {
    const auto& [index, first] = shapes[object.shape].triangles[patch];
    const Mesh& mesh = model.meshes[index];
    std::array<V3d, 3> result;
    for (std::uint32_t c = 0; c < 3; ++c)
        result[c] = to_world(mesh.positions[mesh.indices[first + c]], object.to_world);
    return result;
}

AuthoredDensities authored_densities(const Json& file) {
    AuthoredDensities result;
    const auto visit = [&](const char* list, const auto& add) {
        if (!file.contains(list)) return;
        for (std::uint32_t i = 0; i < file[list].size(); ++i) {
            const Json& holder = file[list][i];
            if (!holder.contains("extras") || !holder["extras"].contains(density_property)) continue;
            const Json& value = holder["extras"][density_property];
            const double density = value.is_number() ? value.get<double>() : -1;
            if (!(density >= 0 && density <= std::numeric_limits<float>::max()))
                throw InputError(fmt::format("{}[{}] '{}': extras.{} is {}, expected a number from 0 up", list, i,
                                             holder.value("name", ""), density_property, json_text(value)));
            add(i, holder.value("name", ""), static_cast<float>(density));
        }
    };
    visit("nodes", [&](std::uint32_t node, const std::string&, float density) { result.nodes[node] = density; });
    visit("materials", [&](std::uint32_t, const std::string& name, float density) {
        if (!name.empty()) result.materials.push_back({name, density});
    });
    return result;
}

AuthoredCharts authored_charts(Model model, const AuthoredDensities& densities, const LightmapOptions& options,
                               Warnings& warnings) {
    AuthoredCharts result;
    const auto options_with = [&](const std::vector<TexelDensity>& further) {
        LightmapOptions chosen = options;
        chosen.densities.insert(chosen.densities.end(), further.begin(), further.end());
        return chosen;
    };
    const LightmapOptions material_options = options_with(densities.materials);
    Scene scene;
    scene.materials = model.materials;
    // Nodes share a shape if their meshes, densities and metrics are equal
    using ShapesByMetric = std::vector<std::pair<std::array<double, 6>, std::uint32_t>>;  // metric and shape
    std::map<std::tuple<std::vector<std::uint32_t>, std::vector<bool>, std::optional<float>>, ShapesByMetric> shapes;
    for (const auto& [instance, meshes] : shown_meshes(model, warnings)) {
        const std::array<double, 6> metric = metric_of(instance->to_world);
        const std::string& object = model.objects[instance->object];
        const auto own = densities.nodes.find(instance->node);
        const auto density = own == densities.nodes.end() ? std::nullopt : std::optional(own->second);
        ShapesByMetric& alike = shapes[{meshes, matching_densities(object, options), density}];
        const auto is_same = [&](const auto& shape) { return are_alike(metric, shape.first); };
        auto found = std::find_if(alike.begin(), alike.end(), is_same);
        if (found == alike.end()) {
            alike.emplace_back(metric, static_cast<std::uint32_t>(result.shapes.size()));
            found = std::prev(alike.end());
            result.shapes.push_back(shape_of(model, meshes, instance->to_world, object,
                                             density ? options_with({{"*", *density}}) : material_options, scene,
                                             warnings));
        }
        const AuthoredShape& shape = result.shapes[found->second];
        result.objects.push_back({instance->node, found->second, instance->object,
                                  static_cast<std::uint32_t>(result.charts.size()), instance->to_world});
        for (LightmapChart chart : shape.charts) {
            chart.object = instance->object;
            chart.is_updated = std::any_of(chart.patches.begin(), chart.patches.end(), [&](const FlatPatch& flat) {
                const Mesh& mesh = model.meshes[shape.triangles[flat.patch].mesh];
                return is_updated(object, model.materials[mesh.material].name, options);
            });
            result.charts.push_back(std::move(chart));
        }
    }
    result.model = std::move(model);
    return result;
}

}  // namespace interflect::detail
