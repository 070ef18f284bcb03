#include "interflect/geometry/surfaces/flat_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/search/disjoint_sets.h"
#include "interflect/geometry/search/vertex_weld.h"

namespace interflect::detail {

namespace {

/// Cosine of 0.8 degrees, which tolerates the rounded normals of small patches but keeps modelled creases.
constexpr float same_plane_cosine = 0.9999f;

constexpr std::size_t patches_per_task = 4096;

/// Each face at an edge is compared with at most this number of others, because all pairs cost the square of the
/// number.
constexpr std::size_t max_compared_faces = 7;

/// Relative difference up to which areas count as equal, because division into patches and rounding change them.
constexpr double equal_areas = 1e-4;

struct Edge {
    std::uint64_t vertices;
    PatchIndex patch;
};

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

bool is_back(const Scene& scene, PatchIndex patch) { return scene.patches[patch].other_side < patch; }

std::vector<std::uint32_t> joined_vertices(const Scene& scene) {
    std::vector<std::uint32_t> joined(scene.vertices.size());
    std::iota(joined.begin(), joined.end(), 0u);
    if (scene.texture_coordinates.empty() && scene.lightmap_coordinates.empty() && scene.normals.empty()) return joined;
    Scene positions;
    VertexWeld weld(positions);
    for (std::size_t i = 0; i < joined.size(); ++i) joined[i] = weld.vertex(scene.vertices[i]);
    return joined;
}

std::vector<Edge> sorted_edges(const Scene& scene) {
    const std::vector<std::uint32_t> joined = joined_vertices(scene);
    std::vector<Edge> edges;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        if (is_back(scene, i)) continue;
        const Patch& patch = scene.patches[i];
        const auto count = static_cast<std::size_t>(patch.vertex_count());
        for (std::size_t v = 0; v < count; ++v)
            edges.push_back({edge_key(joined[patch.vertices[v]], joined[patch.vertices[(v + 1) % count]]), i});
    }
    parallel_sort(edges, [](const Edge& a, const Edge& b) {
        return std::tie(a.vertices, a.patch) < std::tie(b.vertices, b.patch);
    });
    return edges;
}

/// Returns the place of each surface in the order of areas. The result and `area` are indexed by representative.
std::vector<std::uint32_t> order_of_surfaces(const Scene& scene, const std::vector<std::uint32_t>& surface,
                                             const std::vector<double>& area) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < surface.size(); ++i)
        if (surface[i] == i) order.push_back(i);
    parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) { return std::tie(area[a], a) < std::tie(area[b], b); });
    const auto is_dark = [&](std::uint32_t i) {
        return !(channel_sum(scene.materials[scene.patches[i].material].exitance) > 0);
    };
    for (auto first = order.begin(); first != order.end();) {
        const auto end = std::find_if(first, order.end(),
                                      [&](std::uint32_t i) { return area[i] > (1 + equal_areas) * area[*first]; });
        std::sort(first, end, [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(is_dark(a), a) < std::pair(is_dark(b), b);
        });
        first = end;
    }
    std::vector<std::uint32_t> place(surface.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k]] = k;
    return place;
}

}  // namespace

std::vector<std::uint32_t> flat_surfaces(const Scene& scene) {
    const auto count = static_cast<std::uint32_t>(scene.patches.size());
    std::vector<V3f> normal(count);
    parallel_for_ranges(count, patches_per_task, [&](std::size_t begin, std::size_t end) {
        for (PatchIndex i(begin); i < end; ++i) {
            if (is_back(scene, i)) continue;
            normal[i] = PatchGeometry(scene, scene.patches[i]).normal();
        }
    });
    const auto continues = [&](PatchIndex a, PatchIndex b) {
        const Patch &p = scene.patches[a], &q = scene.patches[b];
        return p.material == q.material && p.object == q.object &&
               std::abs(normal[a].dot(normal[b])) > same_plane_cosine;
    };

    // Unite patches that continue across a common edge
    DisjointSets surfaces(count);
    const std::vector<Edge> edges = sorted_edges(scene);
    for (std::size_t i = 1; i < edges.size(); ++i)
        for (std::size_t j = i; j-- > 0 && i - j <= max_compared_faces && edges[j].vertices == edges[i].vertices;)
            if (continues(edges[i].patch, edges[j].patch)) surfaces.unite(edges[i].patch, edges[j].patch);

    // Unite the pieces of cut surfaces, which have equal Patch::surface
    std::unordered_map<std::uint32_t, std::uint32_t> first_patch;
    for (PatchIndex i{0}; i < count; ++i)
        if (!is_back(scene, i) && scene.patches[i].surface != none)
            surfaces.unite(first_patch.try_emplace(scene.patches[i].surface, i).first->second, i);

    std::vector<std::uint32_t> surface(count);
    for (PatchIndex i{0}; i < count; ++i)
        surface[i] = surfaces.find(is_back(scene, i) ? scene.patches[i].other_side : i);
    return surface;
}

std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene) {
    const auto count = static_cast<std::uint32_t>(scene.patches.size());
    const std::vector<std::uint32_t> surface = flat_surfaces(scene);
    std::vector<double> area(count, 0.0);  // area of each surface, indexed by representative [m^2]
    for (PatchIndex i{0}; i < count; ++i)
        if (!is_back(scene, i)) area[surface[i]] += static_cast<double>(patch_area(scene, scene.patches[i]));

    const std::vector<std::uint32_t> place = order_of_surfaces(scene, surface, area);
    std::vector<std::uint32_t> order(count), rank(count);
    std::iota(order.begin(), order.end(), 0u);
    parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(place[surface[a]], a) < std::tie(place[surface[b]], b);
    });
    for (PatchIndex i{0}; i < count; ++i) rank[order[i]] = i;
    return rank;
}

}  // namespace interflect::detail
