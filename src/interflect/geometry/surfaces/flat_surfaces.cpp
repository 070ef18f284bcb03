#include "interflect/geometry/surfaces/flat_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
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

constexpr std::size_t patches_per_task = 4096, vertices_per_task = 4096;

/// Each face at an edge is compared with at most this number of others, because all pairs cost the square of the
/// number.
constexpr std::size_t max_compared_faces = 7;

/// Relative difference up to which areas count as equal, because division into patches and rounding change them.
constexpr double equal_areas = 1e-4;

/// An edge of a patch, in the list of its lower vertex.
struct Edge {
    std::uint32_t higher_vertex;
    PatchIndex patch;
};

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

/// Edges of all faces, in lists by their lower vertex. Each list is sorted by the higher vertex, then by the patch.
class EdgeLists {
  public:
    explicit EdgeLists(const Scene& scene) : start_(scene.vertices.size() + 1, 0) {
        const std::vector<std::uint32_t> joined = joined_vertices(scene);
        const auto visit_edges = [&](const auto& visit) {
            for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
                if (is_back(scene, i)) continue;
                const Patch& patch = scene.patches[i];
                const auto count = static_cast<std::size_t>(patch.vertex_count());
                for (std::size_t v = 0; v < count; ++v) {
                    const auto [low, high] =
                        std::minmax(joined[patch.vertices[v]], joined[patch.vertices[v + 1 == count ? 0 : v + 1]]);
                    visit(low, Edge{high, i});
                }
            }
        };
        visit_edges([&](std::uint32_t low, const Edge&) { ++start_[low + 1]; });
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        edges_.resize(start_.back());
        std::vector<std::uint32_t> end(start_.begin(), start_.end() - 1);
        visit_edges([&](std::uint32_t low, const Edge& edge) { edges_[end[low]++] = edge; });
        parallel_for_ranges(vertex_count(), vertices_per_task, [&](std::size_t begin, std::size_t last) {
            for (std::size_t v = begin; v < last; ++v)
                std::sort(edges_.begin() + start_[v], edges_.begin() + start_[v + 1], [](const Edge& a, const Edge& b) {
                    return std::pair(a.higher_vertex, a.patch.value) < std::pair(b.higher_vertex, b.patch.value);
                });
        });
    }

    std::size_t vertex_count() const { return start_.size() - 1; }
    std::span<const Edge> at(std::size_t lower_vertex) const {
        return std::span(edges_).subspan(start_[lower_vertex], start_[lower_vertex + 1] - start_[lower_vertex]);
    }

  private:
    std::vector<std::uint32_t> start_;  // of each list in edges_, and the end
    std::vector<Edge> edges_;
};

/// Calls visit(a, b) for pairs of patches with a common edge. At an edge of many patches, it omits distant pairs.
template <class Visit>
void visit_neighbours(std::span<const Edge> edges, const Visit& visit) {
    for (std::size_t i = 1; i < edges.size(); ++i)
        for (std::size_t j = i;
             j-- > 0 && i - j <= max_compared_faces && edges[j].higher_vertex == edges[i].higher_vertex;)
            visit(edges[i].patch, edges[j].patch);
}

/// Returns the place of each surface in the order of areas. The result and `area` are indexed by representative.
std::vector<std::uint32_t> order_of_surfaces(const Scene& scene, const std::vector<std::uint32_t>& surface,
                                             const std::vector<double>& area) {
    struct Surface {
        double area;  // [m^2]
        std::uint32_t index;
    };
    std::vector<Surface> order;
    for (std::uint32_t i = 0; i < surface.size(); ++i)
        if (surface[i] == i) order.push_back({area[i], i});
    parallel_sort(order, [](const Surface& a, const Surface& b) {
        return std::pair(a.area, a.index) < std::pair(b.area, b.index);
    });
    const auto emits = [&](const Surface& s) {
        return channel_sum(scene.materials[scene.patches[s.index].material].exitance) > 0;
    };
    for (auto first = order.begin(); first != order.end();) {
        const double largest = (1 + equal_areas) * first->area;
        const auto end = std::find_if(first, order.end(), [&](const Surface& s) { return s.area > largest; });
        std::sort(first, end, [](const Surface& a, const Surface& b) { return a.index < b.index; });
        std::stable_partition(first, end, emits);
        first = end;
    }
    std::vector<std::uint32_t> place(surface.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k].index] = k;
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
    const EdgeLists edges(scene);
    std::vector<std::vector<std::pair<PatchIndex, PatchIndex>>> found((edges.vertex_count() + vertices_per_task - 1) /
                                                                      vertices_per_task);
    parallel_for_ranges(edges.vertex_count(), vertices_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            visit_neighbours(edges.at(v), [&](PatchIndex a, PatchIndex b) {
                if (continues(a, b)) found[begin / vertices_per_task].emplace_back(a, b);
            });
    });
    for (const auto& pairs : found)
        for (const auto& [a, b] : pairs) surfaces.unite(a, b);

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
    return rank_by_flat_surface(scene, flat_surfaces(scene));
}

std::vector<std::uint32_t> rank_by_flat_surface(const Scene& scene, const std::vector<std::uint32_t>& surface) {
    const auto count = static_cast<std::uint32_t>(scene.patches.size());
    std::vector<double> area(count, 0.0);  // area of each surface, indexed by representative [m^2]
    for (PatchIndex i{0}; i < count; ++i)
        if (!is_back(scene, i)) area[surface[i]] += static_cast<double>(patch_area(scene, scene.patches[i]));

    // Count the patches of each surface, then number them
    const std::vector<std::uint32_t> place = order_of_surfaces(scene, surface, area);
    std::vector<std::uint32_t> next(count + std::size_t{1}, 0), rank(count);
    for (std::uint32_t i = 0; i < count; ++i) ++next[place[surface[i]] + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::uint32_t i = 0; i < count; ++i) rank[i] = next[place[surface[i]]]++;
    return rank;
}

}  // namespace interflect::detail
