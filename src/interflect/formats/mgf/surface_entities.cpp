#include "interflect/formats/mgf/reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace interflect::detail {

using Imath::M44d;
using Imath::V3d;

V3d MgfReader::normal_of(std::string_view vertex) {
    const V3d n = vertices_.find(vertex).normal;
    if (n == V3d(0)) throw MgfFault(fmt::format("vertex '{}' needs a normal (n) here", vertex));
    return n;
}

void MgfReader::texture_coordinate(MgfWords words) {
    const V2f coordinate(static_cast<float>(number_argument(words[0])), static_cast<float>(number_argument(words[1])));
    if (const std::string fault = texture_coordinate_fault(coordinate); !fault.empty())
        throw MgfFault("this vertex " + fault);
    changed_vertex().texture_coordinate = coordinate;
    vertices_.current().has_texture_coordinate = true;
}

/// @param world  Position [m]. @param to_world  Transform of the vertex.
std::uint32_t MgfReader::scene_vertex(MgfVertex& vertex, const V3d& world, const M44d& to_world) {
    if (transforms_.empty() && vertex.scene_index != none) return vertex.scene_index;
    V3d normal(0);  // multDirMatrix() suffices: MGF scales uniformly
    if (vertex.normal != V3d(0)) to_world.multDirMatrix(vertex.normal, normal);
    const std::uint32_t index = scene_.vertex(world, vertex.coordinate(), normal);
    if (transforms_.empty()) vertex.scene_index = index;
    return index;
}

void MgfReader::read_loop(MgfWords names, std::vector<std::uint32_t>& loop) {
    if (names.size() > options_.max_face_vertices)
        throw MgfFault(
            fmt::format("a face of {} vertices; at most {} are read", names.size(), options_.max_face_vertices));
    const M44d to_world = total_transform();
    const bool is_textured = materials_.current().is_textured();
    loop.clear();
    outline_.clear();
    for (const std::string_view name : names) {
        MgfVertex& vertex = vertices_.find(name);
        if (is_textured && !vertex.has_texture_coordinate)
            throw MgfFault(fmt::format("vertex '{}' needs texture coordinates (uv): the material has a texture", name));
        outline_.push_back(vertex.point * to_world);
        loop.push_back(scene_vertex(vertex, outline_.back(), to_world));
    }
    if (&loop == &loops_.front()) scene_.place_face(outline_);
    // Mirroring reverses the orientation; the axes and the unit of the file do not mirror.
    if (!transforms_.empty() && to_world.determinant() < 0) std::reverse(loop.begin(), loop.end());
}

std::uint32_t MgfReader::usable_material() {
    MgfMaterial& material = materials_.current();
    faults_.refuse_faults_of(material);
    return scene_.material(material, materials_.current_name());
}

void MgfReader::add_face() {
    const std::uint32_t material = usable_material();
    scene_.add_face(loops_, material, objects_.current(), materials_.current().two_sided, here());
}

void MgfReader::face(MgfWords words) {
    if (!has_three_distinct(words)) {
        for (const std::string_view name : words) vertices_.find(name);
        scene_.leave_out("face with fewer than three different vertices is left out", here());
        return;
    }
    loops_.resize(1);
    read_loop(words, loops_[0]);
    add_face();
}

void MgfReader::face_with_holes(MgfWords words) {
    loops_.clear();
    std::size_t vertices = 0;
    for (auto begin = words.begin(); begin != words.end();) {
        const auto end = std::find(begin, words.end(), "-");
        if (!has_three_distinct({begin, end}))
            throw MgfFault("a face, and each of its holes, needs three different vertices");
        read_loop({begin, end}, loops_.emplace_back());
        vertices += loops_.back().size();
        begin = end == words.end() ? end : end + 1;
    }
    if (vertices > options_.max_face_vertices)
        throw MgfFault(fmt::format("a face of {} vertices; at most {} are read", vertices, options_.max_face_vertices));
    add_face();
}

void MgfReader::add_mesh(const PolygonMesh& mesh) {
    const std::uint32_t material = usable_material();
    if (materials_.current().is_textured())
        throw MgfFault("the material has a texture, and only faces (f, fh) have texture coordinates");
    const M44d to_world = total_transform();
    const bool mirrored = to_world.determinant() < 0;
    count_repeated(mesh.faces.size());
    std::vector<V3d> points;
    std::vector<std::uint32_t> vertex;
    for (const V3d& p : mesh.points) {
        points.push_back(p * to_world);
        vertex.push_back(scene_.vertex(points.back(), std::nullopt));
    }
    loops_.resize(1);
    for (const auto& face : mesh.faces) {
        loops_[0].clear();
        outline_.clear();
        for (const std::uint32_t i : face) {
            loops_[0].push_back(vertex[i]);
            outline_.push_back(points[i]);
        }
        scene_.place_face(outline_);
        if (mirrored) std::reverse(loops_[0].begin(), loops_[0].end());
        scene_.add_face(loops_, material, objects_.current(), materials_.current().two_sided, here());
    }
}

Tessellation MgfReader::tessellation() {
    return {.divisions = options_.curve_divisions, .keeps_area = materials_.current().ed > 0};
}

void MgfReader::sphere(MgfWords words) {
    scene_.require_room(8.0 * options_.curve_divisions * options_.curve_divisions);
    add_mesh(make_sphere(vertices_.find(words[0]).point, number_argument(words[1]), tessellation()));
}

void MgfReader::torus(MgfWords words) {
    scene_.require_room(16.0 * options_.curve_divisions * options_.curve_divisions);
    add_mesh(make_torus(vertices_.find(words[0]).point, normal_of(words[0]), number_argument(words[1]),
                        number_argument(words[2]), tessellation()));
}

void MgfReader::cylinder(MgfWords words) {
    const double radius = number_argument(words[1]);
    add_mesh(make_cone(vertices_.find(words[0]).point, radius, vertices_.find(words[2]).point, radius, tessellation()));
}

void MgfReader::cone(MgfWords words) {
    add_mesh(make_cone(vertices_.find(words[0]).point, number_argument(words[1]), vertices_.find(words[2]).point,
                       number_argument(words[3]), tessellation()));
}

void MgfReader::ring(MgfWords words) {
    add_mesh(make_ring(vertices_.find(words[0]).point, normal_of(words[0]), number_argument(words[1]),
                       number_argument(words[2]), tessellation()));
}

void MgfReader::prism(MgfWords words) {
    const MgfWords names = words.first(words.size() - 1);
    if (names.size() > options_.max_face_vertices)
        throw MgfFault(
            fmt::format("a prism of {} vertices; at most {} are read", names.size(), options_.max_face_vertices));
    std::vector<V3d> outline;
    for (const std::string_view name : names) outline.push_back(vertices_.find(name).point);
    add_mesh(make_prism(outline, number_argument(words.back())));
}

}  // namespace interflect::detail
