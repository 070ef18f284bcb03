#include "interflect/image/smooth_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "interflect/base/disjoint_sets.h"
#include "interflect/base/random.h"
#include "interflect/scene/patch_geometry.h"

namespace interflect {

namespace {

/// An edge that more patches share is taken as a crease: no smooth surface looks so, and all pairs are compared.
constexpr std::size_t most_patches_at_an_edge = 64;

/// Vertices closer than this share of the scene's largest coordinate are one: eight steps of a float there, more than
/// what rounding moves a point by when it is computed from either end of an edge.
constexpr float weld_share = 0x1p-20f;

/// Finds vertices by where they are: a hash grid of cells four times as wide as the distance within which vertices are
/// the same, so that most searches look into one cell.
class VertexGrid {
  public:
    explicit VertexGrid(const std::vector<V3f>& positions) : positions_(positions), next_(positions.size(), none) {
        float largest = 0;
        for (const V3f& p : positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        tolerance_ = weld_share * largest;
        first_.reserve(positions.size());
    }

    /// An earlier vertex at the place of vertex `i`; where there is none, `i`, which later ones then find.
    std::uint32_t weld(std::uint32_t i) {
        const Cell low = cell_of(positions_[i] - V3f(tolerance_)), high = cell_of(positions_[i] + V3f(tolerance_));
        for (std::int64_t x = low.x; x <= high.x; ++x)
            for (std::int64_t y = low.y; y <= high.y; ++y)
                for (std::int64_t z = low.z; z <= high.z; ++z)
                    if (const std::uint32_t same = find_in({x, y, z}, positions_[i]); same != none) return same;
        const auto [entry, is_new] = first_.try_emplace(cell_of(positions_[i]), i);
        if (!is_new) next_[i] = std::exchange(entry->second, i);
        return i;
    }

  private:
    using Cell = Imath::Vec3<std::int64_t>;
    struct CellHash {
        std::size_t operator()(const Cell& c) const { return mix(mix(c.x, c.y), c.z); }
    };

    Cell cell_of(const V3f& p) const {
        const double size = 4 * std::max(static_cast<double>(tolerance_), std::numeric_limits<double>::min());
        const auto index = [&](float v) { return static_cast<std::int64_t>(std::floor(v / size)); };
        return {index(p.x), index(p.y), index(p.z)};
    }
    std::uint32_t find_in(const Cell& cell, const V3f& p) const {
        const auto entry = first_.find(cell);
        if (entry == first_.end()) return none;
        std::uint32_t i = entry->second;
        while (i != none && (positions_[i] - p).length() > tolerance_) i = next_[i];
        return i;
    }

    const std::vector<V3f>& positions_;
    std::unordered_map<Cell, std::uint32_t, CellHash> first_;  // the latest vertex in each cell
    std::vector<std::uint32_t> next_;                          // the one before it in the same cell
    float tolerance_ = 0;                                      // [m]
};

/// For each vertex the first one at the same place.
std::vector<std::uint32_t> weld(const std::vector<V3f>& positions) {
    VertexGrid grid(positions);
    std::vector<std::uint32_t> welded(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) welded[i] = grid.weld(i);
    return welded;
}

/// An edge as one patch sees it; the patch's vertex order runs along it from `start` to `end`, which are corners.
struct PatchEdge {
    std::uint32_t low, high;   // welded vertices, low < high: the same for every patch at the edge
    std::uint32_t start, end;  // 4 patch + corner; start also is the number of the edge
    bool upwards;              // the patch runs from low to high

    std::uint32_t patch() const { return start / 4; }
    friend bool operator<(const PatchEdge& a, const PatchEdge& b) {
        return std::tie(a.low, a.high, a.start) < std::tie(b.low, b.high, b.start);
    }
    bool same_place(const PatchEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<PatchEdge> sorted_edges(const Scene& scene) {
    const std::vector<std::uint32_t> welded = weld(scene.vertices);
    std::vector<PatchEdge> edges;
    edges.reserve(4 * scene.patches.size());
    for (std::uint32_t p = 0; p < scene.patches.size(); ++p) {
        const Patch& patch = scene.patches[p];
        const auto corners = static_cast<std::uint32_t>(patch.vertex_count());
        for (std::uint32_t c = 0; c < corners; ++c) {
            const std::uint32_t next = (c + 1) % corners;
            const std::uint32_t from = welded[patch.vertices[c]], to = welded[patch.vertices[next]];
            edges.push_back({std::min(from, to), std::max(from, to), 4 * p + c, 4 * p + next, from < to});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Unit normals towards the lit side.
std::vector<V3f> patch_normals(const Scene& scene) {
    std::vector<V3f> normals;
    normals.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) normals.push_back(PatchGeometry(scene, patch).normal());
    return normals;
}

/// Numbers the sets of corners, or of edges, that patches have.
SmoothSurfaces::Groups number_groups(const Scene& scene, DisjointSets& sets) {
    SmoothSurfaces::Groups groups;
    groups.group.assign(4 * scene.patches.size(), none);
    for (std::uint32_t p = 0; p < scene.patches.size(); ++p)
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(scene.patches[p].vertex_count()); ++c) {
            const std::uint32_t member = 4 * p + c, first = sets.find(member);  // first <= member: numbered already
            groups.group[member] = first == member ? groups.count++ : groups.group[first];
        }
    return groups;
}

}  // namespace

SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options) {
    const float least_cosine = std::cos(options.crease_angle * std::numbers::pi_v<float> / 180);
    const std::vector<V3f> normals = patch_normals(scene);
    const auto smooth = [&](const PatchEdge& a, const PatchEdge& b) {
        return a.upwards != b.upwards && scene.patches[a.patch()].material == scene.patches[b.patch()].material &&
               normals[a.patch()].dot(normals[b.patch()]) >= least_cosine;
    };

    const std::vector<PatchEdge> edges = sorted_edges(scene);
    DisjointSets joined_corners(4 * scene.patches.size()), joined_edges(4 * scene.patches.size());
    const auto join = [&](const PatchEdge& a, const PatchEdge& b) {
        joined_corners.unite(a.start, b.end);
        joined_corners.unite(a.end, b.start);
        joined_edges.unite(a.start, b.start);
    };
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const PatchEdge& e) { return !e.same_place(*first); });
        if (static_cast<std::size_t>(last - first) <= most_patches_at_an_edge)
            for (auto a = first; a != last; ++a)
                for (auto b = a + 1; b != last; ++b)
                    if (smooth(*a, *b)) join(*a, *b);
        first = last;
    }
    return {number_groups(scene, joined_corners), number_groups(scene, joined_edges)};
}

}  // namespace interflect
