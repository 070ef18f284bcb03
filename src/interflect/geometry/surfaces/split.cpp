#include "interflect/prepare.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/geometry/polygons/add_face.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/search/vertex_weld.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/scene/core/core.h"

namespace interflect {

using namespace detail;

namespace {

/// Numbers of pieces along the first and the last edge of a patch; equal for a triangle.
struct Pieces {
    std::uint64_t u = 1, v = 1;
};

std::uint64_t pieces_of_edge(const V3f& a, const V3f& b, float largest_edge) {
    constexpr float most = 1e9f;  // more than any limit of patches
    return static_cast<std::uint64_t>(std::clamp(std::ceil((b - a).length() / largest_edge), 1.0f, most));
}

Pieces pieces_of(const Scene& scene, const Patch& patch, float largest_edge) {
    const auto edge = [&](std::size_t i, std::size_t j) {
        return pieces_of_edge(scene.vertices[patch.vertices[i]], scene.vertices[patch.vertices[j]], largest_edge);
    };
    if (patch.is_triangle()) {
        const std::uint64_t n = std::max({edge(0, 1), edge(1, 2), edge(2, 0)});
        return {n, n};
    }
    return {std::max(edge(0, 1), edge(3, 2)), std::max(edge(1, 2), edge(0, 3))};
}

template <class Vertex, class AddPiece>
void split_quadrilateral(Pieces n, const Vertex& vertex, const AddPiece& add_piece) {
    for (std::uint64_t j = 0; j < n.v; ++j)
        for (std::uint64_t i = 0; i < n.u; ++i)
            add_piece({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
}

template <class Vertex, class AddPiece>
void split_triangle(Pieces n, const Vertex& vertex, const AddPiece& add_piece) {
    for (std::uint64_t j = 0; j < n.u; ++j)
        for (std::uint64_t i = 0; i + j < n.u; ++i) {
            add_piece({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1), none});
            if (i + j + 1 < n.u) add_piece({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1), none});
        }
}

}  // namespace

Scene split_patches(const Scene& scene, float largest_edge, std::uint64_t max_patches) {
    require_no_faults(scene_faults(scene), "cannot divide", scene);
    if (!(largest_edge > 0)) throw InputError(fmt::format("edges of {} m: expected more than 0", largest_edge));

    // Count the pieces
    double count = 0;
    for (const Patch& patch : scene.patches) {
        const Pieces n = pieces_of(scene, patch, largest_edge);
        count += static_cast<double>(n.u) * static_cast<double>(n.v);
    }
    if (count > static_cast<double>(max_patches))
        throw InputError(Fault{
            .text = fmt::format("a mesh size of {} m asks for {:.3g} patches, more than the limit of {} (max_patches)",
                                largest_edge, count, max_patches),
            .setting = "max_patches",
            .file = scene.name});

    // Split each face, and weld the vertices of adjacent pieces
    Scene split = scene;
    split.vertices.clear();
    split.texture_coordinates.clear();
    split.lightmap_coordinates.clear();
    split.normals.clear();
    split.patches.clear();
    split.patches.reserve(static_cast<std::size_t>(count));
    VertexWeld weld(split);
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side != none && patch.other_side < i) continue;
        const PatchGeometry geometry(scene, patch);
        const Pieces n = pieces_of(scene, patch, largest_edge);
        const auto vertex = [&](std::uint64_t along_first, std::uint64_t along_last) {
            const Parameters p{static_cast<float>(along_first) / static_cast<float>(n.u),
                               static_cast<float>(along_last) / static_cast<float>(n.v)};
            return weld.vertex(geometry.point(p), coordinates_at(scene, patch, p));
        };
        const auto add_piece = [&, back = back_material(scene, patch)](const std::array<std::uint32_t, 4>& vertices) {
            Patch piece = patch;
            piece.vertices = vertices;
            add_face(split, piece, back);
        };
        if (patch.is_triangle())
            split_triangle(n, vertex, add_piece);
        else
            split_quadrilateral(n, vertex, add_piece);
    }
    return split;
}

double default_element_size(const Scene& scene) {
    constexpr double largest = 0.005;  // [m]
    constexpr double typical_side_over_size = 1000;
    std::vector<float> areas(scene.patches.size());
    parallel_for_indices(areas.size(), [&](std::size_t i) { areas[i] = patch_area(scene, scene.patches[i]); });
    const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
    parallel_sort(areas, std::less<>());
    double below = 0;
    for (const float area : areas)
        if ((below += area) >= all / 2)
            return std::min(largest, std::sqrt(static_cast<double>(area)) / typical_side_over_size);
    return largest;
}

float default_mesh_size(const Scene& scene) {
    constexpr float pieces_of_diagonal = 48;
    constexpr double moderate_patches = 200'000;
    const Imath::Box3f box = core_bounds(scene);
    double area = 0;
    for (const Patch& patch : scene.patches) area += patch_area(scene, patch);
    return std::max(box.size().length() / pieces_of_diagonal, static_cast<float>(std::sqrt(area / moderate_patches)));
}

}  // namespace interflect
