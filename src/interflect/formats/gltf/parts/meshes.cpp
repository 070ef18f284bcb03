#include "interflect/formats/gltf/parts/meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "interflect/core.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

constexpr int float_component = 5126;
constexpr const char* lightmap_set = "TEXCOORD_1";  // set of texture coordinates that lightmaps use by convention
constexpr const char* normal_set = "NORMAL";
/// Distance beyond 0 or 1 that counts as rounding.
constexpr double lightmap_tolerance = 1e-4;
enum Mode { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

V3d vector_at(const GltfElements& elements, std::uint64_t i) {
    return {elements.number(i, 0), elements.number(i, 1), elements.number(i, 2)};
}

GltfElements elements_of(const DracoAttribute& attribute, std::uint64_t count) {
    return {.first = reinterpret_cast<const char*>(attribute.values.data()),
            .stride = static_cast<std::size_t>(attribute.components) * sizeof(float),
            .count = count,
            .component_type = float_component,
            .components = attribute.components};
}

/// Returns three corners per triangle. Splits strips and fans, and omits degenerate triangles.
std::vector<std::uint32_t> as_triangles(const std::vector<std::uint32_t>& corners, std::uint64_t mode) {
    if (mode == triangles) return corners;
    std::vector<std::uint32_t> result;
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const std::size_t odd = i % 2;
        const std::uint32_t a = corners[mode == triangle_fan ? 0 : i];
        const std::uint32_t b = corners[mode == triangle_fan ? i + 1 : i + 1 + odd];
        const std::uint32_t c = corners[mode == triangle_fan ? i + 2 : i + 2 - odd];
        if (a != b && b != c && c != a) result.insert(result.end(), {a, b, c});
    }
    return result;
}

/// If corners are fewer than vertices, drops unused vertices and renumbers `indices`. Returns the kept ones, ascending.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& indices, std::uint64_t vertex_count) {
    std::vector<std::uint32_t> used;
    if (indices.size() >= vertex_count) {
        used.resize(vertex_count);
        std::iota(used.begin(), used.end(), 0u);
        return used;
    }
    used = indices;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& index : indices)
        index = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), index) - used.begin());
    return used;
}

}  // namespace

/// Attributes of a primitive, with its morph targets and skin.
struct GltfMeshes::Vertices {
    struct Target {
        GltfElements offsets;
        double weight;
    };
    GltfElements positions;
    std::optional<GltfElements> texture_coordinates, lightmap_coordinates, normals;
    DracoMesh draco;  // owns decoded elements
    std::vector<Target> targets;
    GltfElements joint_indices, joint_weights;
    std::span<const Imath::M44d> joints;

    V3d position(std::uint64_t i, const GltfValue& primitive) const {
        V3d result = vector_at(positions, i);
        for (const Target& target : targets) result += vector_at(target.offsets, i) * target.weight;
        return joints.empty() ? result : skinned(result, i, primitive);
    }
    V3d skinned(const V3d& position, std::uint64_t i, const GltfValue& primitive) const {
        V3d result(0);
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
            const double weight = joint_weights.number(i, k), joint = joint_indices.number(i, k);
            if (weight == 0) continue;
            if (!(joint < static_cast<double>(joints.size())))
                primitive.fail(
                    fmt::format("vertex {} has joint {}, but the skin has {} joints", i, joint, joints.size()));
            result += position * joints[static_cast<std::size_t>(joint)] * weight;
            sum += weight;
        }
        return sum > 0 ? result / sum : position;
    }
};

GltfMeshes::GltfMeshes(GltfAsset& asset, GltfBuffers& buffers, GltfAccessors& accessors, GltfMaterials& materials)
    : asset_(asset),
      buffers_(buffers),
      accessors_(accessors),
      materials_(materials),
      meshes_(asset.root().objects("meshes")) {}

void GltfMeshes::count_triangles(std::uint64_t count, const GltfValue& primitive) {
    triangles_ += count;
    if (triangles_ > asset_.options().max_patches)
        primitive.fail(fmt::format("with its {} triangles, the meshes exceed the limit of {} patches (max_patches)",
                                   count, asset_.options().max_patches),
                       "max_patches");
}

GltfElements GltfMeshes::attribute(const GltfValue& primitive, const char* key, const char* types) {
    const GltfValue attributes = primitive.object("attributes");
    return accessors_.elements(attributes.required_index(key, accessors_.count()), types, attributes);
}

/// Returns the name of the attribute with texture coordinates, or "" for a material without textures.
std::string GltfMeshes::texture_set_of(const GltfValue& primitive) {
    const GltfSurface& surface = materials_.surface(primitive.index("material", materials_.count()), /*textured=*/true);
    return surface.mapping ? fmt::format("TEXCOORD_{}", surface.mapping->set) : "";
}

void GltfMeshes::read_draco(const GltfValue& primitive, const GltfValue& extension, Vertices& vertices) {
    const GltfValue ids = extension.object("attributes");
    constexpr std::size_t max_ids = 1 << 16;
    std::vector<std::uint32_t> wanted = {ids.required_index("POSITION", max_ids)};
    const std::string texture_set = texture_set_of(primitive);
    const auto want = [&](const std::string& set) -> std::optional<std::size_t> {
        if (set.empty() || !ids.has(set.c_str())) return std::nullopt;
        wanted.push_back(ids.index(set.c_str(), max_ids));
        return wanted.size() - 1;
    };
    const auto texture_coordinates = want(texture_set), lightmap = want(lightmap_set), normals = want(normal_set);
    const auto view = buffers_.view(extension.required_index("bufferView", buffers_.view_count()));
    // Only the counts of these elements are used.
    const GltfElements indices =
        accessors_.elements(primitive.required_index("indices", accessors_.count()), "SCALAR", primitive);
    const GltfElements positions = attribute(primitive, "POSITION", "VEC3");
    count_triangles(indices.count / 3, primitive);
    // This check limits the decoder's memory.
    if (positions.count > indices.count) extension.fail("it has more vertices than corners");
    vertices.draco = decode_draco(view.bytes, wanted, indices.count / 3, positions.count, extension);
    const auto decoded = [&](std::size_t i) {
        return elements_of(vertices.draco.attributes[i], vertices.draco.vertex_count);
    };
    vertices.positions = decoded(0);
    if (texture_coordinates) vertices.texture_coordinates = decoded(*texture_coordinates);
    if (lightmap) vertices.lightmap_coordinates = decoded(*lightmap);
    if (normals) vertices.normals = decoded(*normals);
}

void GltfMeshes::read_deformation(const GltfValue& primitive, const GltfPose& pose, Vertices& vertices) {
    const auto require_count = [&](const GltfElements& elements, const GltfValue& owner) {
        if (elements.count != vertices.positions.count)
            owner.fail(fmt::format("{} elements for {} vertices", elements.count, vertices.positions.count));
    };
    const std::vector<GltfValue> targets = primitive.objects("targets");
    for (std::size_t i = 0; i < std::min(targets.size(), pose.weights.size()); ++i) {
        if (pose.weights[i] == 0 || !targets[i].has("POSITION")) continue;
        const std::uint32_t accessor = targets[i].index("POSITION", accessors_.count());
        vertices.targets.push_back({accessors_.elements(accessor, "VEC3", targets[i]), pose.weights[i]});
        require_count(vertices.targets.back().offsets, targets[i]);
    }
    if (pose.joints.empty() || !primitive.object("attributes").has("JOINTS_0")) return;
    vertices.joint_indices = attribute(primitive, "JOINTS_0", "VEC4");
    vertices.joint_weights = attribute(primitive, "WEIGHTS_0", "VEC4");
    require_count(vertices.joint_indices, primitive);
    require_count(vertices.joint_weights, primitive);
    vertices.joints = pose.joints;
}

GltfMeshes::Vertices GltfMeshes::vertices_of(const GltfValue& primitive) {
    Vertices vertices;
    const GltfValue attributes = primitive.object("attributes");
    if (const GltfValue draco = primitive.extension("KHR_draco_mesh_compression"); draco.exists()) {
        read_draco(primitive, draco, vertices);
    } else {
        vertices.positions = attribute(primitive, "POSITION", "VEC3");
        if (vertices.positions.stride == 0) attributes.fail("the accessor of POSITION has no data");
        const std::string texture_set = texture_set_of(primitive);
        if (!texture_set.empty() && attributes.has(texture_set.c_str()))
            vertices.texture_coordinates = attribute(primitive, texture_set.c_str(), "VEC2");
        if (attributes.has(lightmap_set)) vertices.lightmap_coordinates = attribute(primitive, lightmap_set, "VEC2");
        if (attributes.has(normal_set)) vertices.normals = attribute(primitive, normal_set, "VEC3");
    }
    const auto require_components = [&](const std::string& name, const GltfElements& elements, int expected) {
        if (elements.components != expected)
            attributes.fail(fmt::format("{} has {} components, expected {}", name, elements.components, expected));
    };
    const auto require_shape = [&](const std::string& name, const std::optional<GltfElements>& elements, int components,
                                   const char* plural) {
        if (!elements) return;
        require_components(name, *elements, components);
        if (elements->count != vertices.positions.count)
            attributes.fail(fmt::format("{} {} for {} vertices", elements->count, plural, vertices.positions.count));
    };
    require_components("POSITION", vertices.positions, 3);
    require_shape(texture_set_of(primitive), vertices.texture_coordinates, 2, "texture coordinates");
    require_shape(lightmap_set, vertices.lightmap_coordinates, 2, "texture coordinates");
    require_shape(normal_set, vertices.normals, 3, "normals");
    return vertices;
}

std::vector<std::uint32_t> GltfMeshes::corners_of(const GltfValue& primitive, Vertices& vertices) {
    const std::uint64_t mode = primitive.integer("mode", triangles);
    const auto check_corner_count = [&](std::uint64_t corners, const char* plural) {
        if (mode == triangles && corners % 3 != 0)
            primitive.fail(fmt::format("{} {}, expected a multiple of 3", corners, plural));
        count_triangles(mode == triangles ? corners / 3 : std::max<std::uint64_t>(corners, 2) - 2, primitive);
    };
    std::vector<std::uint32_t> corners;
    const std::uint64_t vertex_count = vertices.positions.count;
    if (primitive.extension("KHR_draco_mesh_compression").exists()) {
        return std::move(vertices.draco.indices);  // read_draco() has counted them
    } else if (primitive.has("indices")) {
        const GltfElements indices = accessors_.indices(primitive.index("indices", accessors_.count()), primitive);
        check_corner_count(indices.count, "indices");
        corners.reserve(indices.count);
        for (std::uint64_t i = 0; i < indices.count; ++i) corners.push_back(indices.whole_number(i));
    } else {
        check_corner_count(vertex_count, "vertices");
        if (vertex_count > std::numeric_limits<std::uint32_t>::max()) primitive.fail("it has too many vertices");
        corners.resize(vertex_count);
        std::iota(corners.begin(), corners.end(), 0u);
    }
    const auto largest = std::max_element(corners.begin(), corners.end());
    if (largest != corners.end() && *largest >= vertex_count)
        primitive.fail(fmt::format("index {} is outside the {} vertices", *largest, vertex_count));
    return as_triangles(corners, mode);
}

void GltfMeshes::add(const GltfValue& primitive, const GltfPose& pose, std::vector<std::uint32_t>& result) {
    const std::uint64_t mode = primitive.integer("mode", triangles);
    if (mode > triangle_fan) primitive.fail(fmt::format("its mode is {}, expected 0 to 6", mode));
    if (mode < triangles) {
        asset_.warn("no-faces", "points and lines are ignored", primitive.place());
        return;
    }
    if (!primitive.object("attributes").has("POSITION")) {
        asset_.warn("no-faces", "a primitive without positions is ignored", primitive.place());
        return;
    }
    Vertices vertices = vertices_of(primitive);
    const GltfSurface& surface =
        materials_.surface(primitive.index("material", materials_.count()), vertices.texture_coordinates.has_value());
    if (surface.is_invisible) return;
    read_deformation(primitive, pose, vertices);

    std::vector<std::uint32_t> corners = corners_of(primitive, vertices);
    for (TintedFaces& faces : by_tint(primitive, std::move(corners), vertices.positions.count)) {
        result.push_back(static_cast<std::uint32_t>(asset_.model.meshes.size()));
        asset_.model.meshes.push_back(mesh_of(primitive, vertices, surface, std::move(faces)));
    }
}

/// Groups triangles by the mean of COLOR_0 at their corners. Similar colours share a group, whose tint is their mean.
std::vector<GltfMeshes::TintedFaces> GltfMeshes::by_tint(const GltfValue& primitive, std::vector<std::uint32_t> indices,
                                                         std::uint64_t vertex_count) {
    constexpr const char* colour_set = "COLOR_0";
    if (indices.empty()) return {};
    if (!primitive.object("attributes").has(colour_set)) return {{Rgb(1), std::move(indices)}};
    if (primitive.extension("KHR_draco_mesh_compression").exists()) {
        asset_.warn("vertex-colours", "compressed colours of vertices (COLOR_0) are ignored", primitive.place());
        return {{Rgb(1), std::move(indices)}};
    }
    const GltfElements colours = attribute(primitive, colour_set, "VEC3 VEC4");
    if (colours.count != vertex_count)
        primitive.fail(fmt::format("{} colours for {} vertices", colours.count, vertex_count));
    const auto colour_at = [&](std::uint32_t v) {
        const V3d colour = vector_at(colours, v);
        Rgb result;
        for (int c = 0; c < 3; ++c) result[c] = static_cast<float>(std::clamp(colour[c], 0.0, 1.0));
        return result;
    };
    // Number of steps of a channel's square root. Colours of a group differ by up to 6% of white.
    constexpr float steps = 16;
    std::map<std::array<int, 3>, TintedFaces> groups;
    bool varies = false;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const Rgb a = colour_at(indices[i]), b = colour_at(indices[i + 1]), c = colour_at(indices[i + 2]);
        varies |= a != b || b != c;
        const Rgb mean = (a + b + c) / 3;
        const auto step = [&](float x) { return static_cast<int>(std::lround(std::sqrt(x) * steps)); };
        TintedFaces& group =
            groups.try_emplace({step(mean.x), step(mean.y), step(mean.z)}, TintedFaces{Rgb(0), {}}).first->second;
        group.tint += mean;
        group.indices.insert(group.indices.end(), indices.begin() + static_cast<std::ptrdiff_t>(i),
                             indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
    }
    if (varies)
        asset_.warn("vertex-colours", "colours of vertices (COLOR_0) are averaged over each triangle",
                    primitive.place());
    std::vector<TintedFaces> result;
    for (auto& [key, group] : groups) {
        const std::size_t triangles = group.indices.size() / 3;
        group.tint /= static_cast<float>(triangles);
        result.push_back(std::move(group));
    }
    return result;
}

Mesh GltfMeshes::mesh_of(const GltfValue& primitive, const Vertices& vertices, const GltfSurface& surface,
                         TintedFaces faces) {
    Mesh mesh;
    mesh.name = primitive.place();
    mesh.material = materials_.tinted(surface.material, faces.tint);
    mesh.back_emits = surface.double_sided;
    mesh.indices = std::move(faces.indices);
    const std::vector<std::uint32_t> used = compact(mesh.indices, vertices.positions.count);
    mesh.positions.reserve(used.size());
    for (const std::uint32_t v : used) mesh.positions.push_back(vertices.position(v, primitive));
    mesh.source.vertices = used;
    if (vertices.normals && vertices.targets.empty() && vertices.joints.empty())  // the mesh is not deformed
        for (const std::uint32_t v : used) mesh.normals.push_back(vector_at(*vertices.normals, v));
    bool is_outside = false;
    if (surface.mapping) {
        const GltfElements& c = *vertices.texture_coordinates;  // a mapping implies coordinates
        mesh.texture_coordinates.reserve(used.size());
        for (const std::uint32_t v : used) {
            const V2f coordinate = surface.mapping->apply(c.number(v, 0), c.number(v, 1));
            is_outside |= std::min(coordinate.x, coordinate.y) < 0 || std::max(coordinate.x, coordinate.y) > 1;
            mesh.texture_coordinates.push_back(coordinate);
        }
    }
    if (is_outside && !surface.repeats)
        asset_.warn("texture-wrap", "clamped or mirrored texture: repeated outside [0, 1] instead", primitive.place());
    if (vertices.lightmap_coordinates) read_lightmap_coordinates(*vertices.lightmap_coordinates, used, mesh);
    return mesh;
}

void GltfMeshes::read_lightmap_coordinates(const GltfElements& set, const std::vector<std::uint32_t>& used,
                                           Mesh& mesh) {
    const auto is_in_range = [](double x) { return x >= -lightmap_tolerance && x <= 1 + lightmap_tolerance; };
    const auto clamped = [](double x) { return static_cast<float>(std::clamp(x, 0.0, 1.0)); };
    mesh.lightmap_coordinates.reserve(used.size());
    for (const std::uint32_t v : used) {
        const double u = set.number(v, 0), v_down = set.number(v, 1);
        if (!is_in_range(u) || !is_in_range(v_down)) {
            asset_.warn("lightmap-coordinates",
                        fmt::format("{} is ignored as a lightmap: its coordinates are outside [0, 1]", lightmap_set),
                        mesh.name);
            mesh.lightmap_coordinates.clear();
            return;
        }
        mesh.lightmap_coordinates.emplace_back(clamped(u), clamped(1 - v_down));
    }
}

const std::vector<std::uint32_t>& GltfMeshes::meshes(std::uint32_t index, const GltfPose& pose) {
    const GltfValue& owner = meshes_[index];
    GltfPose resolved_pose = pose;
    if (resolved_pose.weights.empty()) resolved_pose.weights = owner.numbers("weights");
    const auto [entry, is_new] = mesh_cache_.try_emplace({index, resolved_pose.weights, resolved_pose.skin});
    if (!is_new) return entry->second;
    const std::vector<GltfValue> primitives = owner.objects("primitives");
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
        const std::size_t first = asset_.model.meshes.size();
        add(primitives[i], resolved_pose, entry->second);
        for (std::size_t k = first; k < asset_.model.meshes.size(); ++k) {
            asset_.model.meshes[k].source.mesh = index;
            asset_.model.meshes[k].source.primitive = i;
        }
    }
    return entry->second;
}

}  // namespace interflect::detail
