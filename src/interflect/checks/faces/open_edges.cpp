#include "interflect/checks/faces/open_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace interflect::detail {

namespace {

/// Returns, for each vertex, the first vertex at the same position.
std::vector<std::uint32_t> first_at_position(const Scene& scene) {
    const auto position = [&](std::uint32_t i) {
        const V3f& x = scene.vertices[i];
        return std::tuple(x.x, x.y, x.z);
    };
    std::vector<std::uint32_t> order(scene.vertices.size()), first(scene.vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::tuple(position(i), i) < std::tuple(position(j), j);
    });
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && position(order[k]) == position(order[k - 1]) ? first[order[k - 1]] : order[k];
    return first;
}

}  // namespace

std::vector<OpenEdge> open_edges(const Scene& scene) {
    struct Edge {
        std::uint32_t low, high;
        PatchIndex patch;
    };
    const std::vector<std::uint32_t> vertex = first_at_position(scene);
    std::vector<Edge> edges;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side != none && patch.other_side < i) continue;
        const int count = patch.vertex_count();
        for (int k = 0; k < count; ++k) {
            const std::uint32_t a = vertex[patch.vertices[k]], b = vertex[patch.vertices[(k + 1) % count]];
            edges.push_back({std::min(a, b), std::max(a, b), i});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) {
        return std::tuple(e.low, e.high, e.patch) < std::tuple(f.low, f.high, f.patch);
    });
    const auto is_same = [&](std::size_t i, std::size_t j) {
        return edges[i].low == edges[j].low && edges[i].high == edges[j].high;
    };
    std::vector<OpenEdge> open;
    for (std::size_t i = 0; i < edges.size(); ++i)
        if ((i == 0 || !is_same(i, i - 1)) && (i + 1 == edges.size() || !is_same(i, i + 1)))
            open.push_back({scene.vertices[edges[i].low], scene.vertices[edges[i].high], edges[i].patch});
    std::stable_sort(open.begin(), open.end(), [](const OpenEdge& e, const OpenEdge& f) { return e.patch < f.patch; });
    return open;
}

}  // namespace interflect::detail
