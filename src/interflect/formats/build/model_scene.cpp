#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/build/model.h"
#include "interflect/formats/build/scene_faces.h"
#include "interflect/formats/reading/location.h"
#include "interflect/geometry/polygons/triangle_pairs.h"
#include "interflect/geometry/search/vertex_weld.h"
#include "interflect/scene/core/limits.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

std::size_t face_count(const Mesh& mesh) {
    return mesh.face_sizes.empty() ? mesh.indices.size() / 3 : mesh.face_sizes.size();
}

void for_each_face(const Mesh& mesh, auto use) {
    std::size_t begin = 0;
    for (std::size_t face = 0; face < face_count(mesh); ++face) {
        const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[face];
        use(std::span(mesh.indices).subspan(begin, size));
        begin += size;
    }
}

std::string mesh_fault(const Mesh& mesh, const Model& model, const ReadOptions& options) {
    if (mesh.material >= model.materials.size()) return fmt::format("its material {} does not exist", mesh.material);
    if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != mesh.positions.size())
        return fmt::format("it has {} texture coordinates for {} vertices", mesh.texture_coordinates.size(),
                           mesh.positions.size());
    if (!mesh.lightmap_coordinates.empty() && mesh.lightmap_coordinates.size() != mesh.positions.size())
        return fmt::format("it has {} lightmap coordinates for {} vertices", mesh.lightmap_coordinates.size(),
                           mesh.positions.size());
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        return fmt::format("it has {} normals for {} vertices", mesh.normals.size(), mesh.positions.size());
    if (model.materials[mesh.material].is_textured() && mesh.texture_coordinates.empty())
        return fmt::format("its material '{}' has a texture, but it has no texture coordinates",
                           model.materials[mesh.material].name);
    std::uint64_t corners = 0;
    for (const std::uint32_t size : mesh.face_sizes) {
        if (size < 3 || size > options.max_face_vertices)
            return fmt::format("a face has {} vertices; expected 3 to {}", size, options.max_face_vertices);
        corners += size;
    }
    if (mesh.face_sizes.empty() ? mesh.indices.size() % 3 != 0 : corners != mesh.indices.size())
        return fmt::format("its faces do not use all of its {} indices", mesh.indices.size());
    const auto largest = std::max_element(mesh.indices.begin(), mesh.indices.end());
    if (largest != mesh.indices.end() && *largest >= mesh.positions.size())
        return fmt::format("it uses vertex {}; expected indices below {}, the number of its vertices", *largest,
                           mesh.positions.size());
    return {};
}

void require_valid(const Model& model, const ReadOptions& options) {
    for (const Mesh& mesh : model.meshes)
        if (const std::string fault = mesh_fault(mesh, model, options); !fault.empty())
            throw InputError(model.file, 0, fmt::format("{}: {}", mesh.name, fault));
    double faces = 0;
    for (const MeshInstance& instance : model.instances) {
        if (instance.mesh >= model.meshes.size() || instance.object >= model.objects.size())
            throw InputError(model.file, 0, "an instance shows a mesh or an object that does not exist");
        faces += static_cast<double>(face_count(model.meshes[instance.mesh]));
    }
    // Two triangles may merge into one face, whose sides are two patches, so each triangle gives at least one patch.
    if (faces > static_cast<double>(options.max_patches))
        throw Location{&model.file}.error(
            fmt::format("{:.0f} faces, its instances counted each, would give more than {} patches "
                        "(max_patches)",
                        faces, options.max_patches),
            "max_patches");
}

/// Returns which objects keep their lightmap coordinates.
std::vector<bool> objects_with_layouts(Model& model) {
    std::vector<const MeshInstance*> first(model.objects.size(), nullptr);
    std::vector<bool> has_layout(model.objects.size(), true);
    for (const MeshInstance& instance : model.instances) {
        if (model.meshes[instance.mesh].lightmap_coordinates.empty()) continue;
        if (!first[instance.object]) first[instance.object] = &instance;
        if (instance.to_world == first[instance.object]->to_world || !has_layout[instance.object]) continue;
        has_layout[instance.object] = false;
        model.warnings.add("lightmap-coordinates",
                           "the lightmap coordinates of an object are ignored, since its instances would share them",
                           fmt::format("{}: object '{}'", model.file.string(), model.objects[instance.object]));
    }
    return has_layout;
}

class InstanceAdder {
  public:
    InstanceAdder(const Model& model, const std::vector<bool>& has_layout, Scene& scene, const ReadOptions& options)
        : model_(model), has_layout_(has_layout), scene_(scene), faces_(scene, options), weld_(scene) {}

    /// Returns an origin for the scene. Places the faces without adding them.
    V3d suitable_origin() {
        for (const MeshInstance& instance : model_.instances) {
            const Mesh& mesh = model_.meshes[instance.mesh];
            for_each_face(mesh, [&](auto corners) { place(mesh, instance, corners); });
        }
        return faces_.suitable_origin();
    }

    void add(const MeshInstance& instance) {
        const Mesh& mesh = model_.meshes[instance.mesh];
        const Location where{&model_.file, 0, mesh.name};
        try {
            add(mesh, instance, where);
        } catch (const std::invalid_argument& fault) {
            throw where.error(fault);
        }
    }

    void require_usable() const { faces_.require_usable(); }

  private:
    static V3d to_world(const V3d& x, const MeshInstance& instance) {
        V3d result;
        instance.to_world.multVecMatrix(x, result);
        return result;
    }

    /// Multiplies by the cofactors of the matrix, which transform a normal up to its length and sign.
    static V3f to_world_normal(const V3d& n, const MeshInstance& instance) {
        const Imath::M44d& m = instance.to_world;
        const V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
        return welded_normal(n.x * y.cross(z) + n.y * z.cross(x) + n.z * x.cross(y));
    }

    void place(const Mesh& mesh, const MeshInstance& instance, std::span<const std::uint32_t> corners) {
        outline_.clear();
        for (const std::uint32_t v : corners) outline_.push_back(to_world(mesh.positions[v], instance));
        faces_.place(outline_);
    }

    std::vector<std::uint32_t> weld_vertices(const Mesh& mesh, const MeshInstance& instance) {
        const bool is_textured = model_.materials[mesh.material].is_textured();
        const bool has_layout = !mesh.lightmap_coordinates.empty() && has_layout_[instance.object];
        std::vector<std::uint32_t> vertices;
        vertices.reserve(mesh.positions.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            VertexCoordinates coordinates;
            if (is_textured) coordinates.texture = mesh.texture_coordinates[v];
            if (has_layout) coordinates.lightmap = mesh.lightmap_coordinates[v];
            if (!mesh.normals.empty()) coordinates.normal = to_world_normal(mesh.normals[v], instance);
            vertices.push_back(weld_.vertex(faces_.position(to_world(mesh.positions[v], instance)), coordinates));
        }
        return vertices;
    }

    void add(const Mesh& mesh, const MeshInstance& instance, const Location& where) {
        const std::vector<std::uint32_t> vertices = weld_vertices(mesh, instance);
        const bool is_mirrored = instance.to_world.determinant() < 0;
        const std::size_t first = scene_.patches.size();
        std::vector<std::uint32_t> triangles;
        for_each_face(mesh, [&](auto corners) {
            face_.clear();
            for (const std::uint32_t v : corners) face_.push_back(vertices[v]);
            if (is_mirrored) std::reverse(face_.begin(), face_.end());
            if (face_.size() == 3)
                triangles.insert(triangles.end(), face_.begin(), face_.end());
            else
                add_face(mesh, instance, where);
        });
        for (const FaceVertices& merged : merge_triangle_pairs(scene_, triangles)) {
            face_.assign(merged.begin(), merged[3] == none ? merged.end() - 1 : merged.end());
            add_face(mesh, instance, where);
        }
        if (!mesh.back_emits) darken_backs(first);
    }

    void add_face(const Mesh& mesh, const MeshInstance& instance, const Location& where) {
        outline_.clear();
        for (const std::uint32_t v : face_) outline_.push_back(scene_.origin + V3d(scene_.vertices[v]));
        faces_.place(outline_);
        faces_.add({&face_, 1}, mesh.material, instance.object, true, where);
    }

    /// Removes the emission of backs, which are every second patch from `first` + 1.
    void darken_backs(std::size_t first) {
        if (first == scene_.patches.size()) return;
        const Material& material = scene_.materials[scene_.patches[first].material];
        if (largest_channel(material.exitance) == 0) return;
        Material dark = material;
        dark.exitance = Rgb(0);
        dark.exitance_texture = none;
        std::uint32_t& index = dark_material_[scene_.patches[first].material];
        if (index == none) {
            index = static_cast<std::uint32_t>(scene_.materials.size());
            scene_.materials.push_back(std::move(dark));
        }
        for (std::size_t i = first + 1; i < scene_.patches.size(); i += 2) scene_.patches[i].material = index;
    }

    const Model& model_;
    const std::vector<bool>& has_layout_;
    Scene& scene_;
    SceneFaces faces_;
    VertexWeld weld_;
    std::vector<std::uint32_t> dark_material_ = std::vector(model_.materials.size(), none);
    std::vector<V3d> outline_;
    std::vector<std::uint32_t> face_;
};

Luminaire placed(const PlacedLight& light, const V3d& origin) {
    Luminaire result = light.luminaire;
    std::visit(
        [&](auto& kind) {
            if constexpr (requires { kind.position; }) kind.position = V3f(light.position - origin);
        },
        result.kind);
    return result;
}

}  // namespace

Scene scene_of(Model&& model, const ReadOptions& options) {
    require_valid(model, options);
    if (model.instances.empty() && !model.lights.empty())
        throw InputError(model.file, 0,
                         "no usable face is left: the scene has lights, but no surfaces to receive their light");
    const std::vector<bool> has_layout = objects_with_layouts(model);
    Scene scene;
    scene.name = model.file.string();
    scene.origin = InstanceAdder(model, has_layout, scene, options).suitable_origin();
    scene.materials = model.materials;
    scene.textures = std::move(model.textures);
    scene.objects = std::move(model.objects);
    scene.views = std::move(model.views);
    scene.files = std::move(model.files);
    scene.warnings = std::move(model.warnings);
    for (const PlacedLight& light : model.lights) scene.luminaires.push_back(placed(light, scene.origin));
    InstanceAdder instances(model, has_layout, scene, options);
    for (const MeshInstance& instance : model.instances) instances.add(instance);
    instances.require_usable();
    require_no_faults(scene_faults(scene), "cannot read", scene);
    return scene;
}

}  // namespace interflect::detail
