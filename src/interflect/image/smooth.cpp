#include "interflect/image/smooth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "interflect/base/error.h"
#include "interflect/base/random.h"

namespace interflect {

namespace {

/// An edge that more patches share is taken as a crease: no smooth surface looks so, and all pairs are compared.
constexpr std::size_t most_patches_at_an_edge = 64;

/// Sets of numbers that grow together (union by smaller index, path halving).
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }

    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

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
    std::uint32_t start, end;  // 4 patch + corner
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

/// Joins the corners at both ends of an edge that smooth neighbours share.
void unite_across(const PatchEdge& a, const PatchEdge& b, DisjointSets& corners) {
    corners.unite(a.start, b.end);
    corners.unite(a.end, b.start);
}

/// Unit normals towards the lit side.
std::vector<V3f> patch_normals(const Scene& scene) {
    std::vector<V3f> normals;
    normals.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) normals.push_back(PatchGeometry(scene, patch).normal());
    return normals;
}

/// Numbers the sets of corners that patches have.
CornerGroups number_groups(const Scene& scene, DisjointSets& corners) {
    CornerGroups groups;
    groups.group.assign(4 * scene.patches.size(), none);
    for (std::uint32_t p = 0; p < scene.patches.size(); ++p)
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(scene.patches[p].vertex_count()); ++c) {
            const std::uint32_t corner = 4 * p + c, first = corners.find(corner);  // first <= corner: numbered already
            groups.group[corner] = first == corner ? groups.count++ : groups.group[first];
        }
    return groups;
}

/// The angle of a patch at one of its corners [rad].
float corner_angle(const Scene& scene, const Patch& patch, int corner) {
    const int n = patch.vertex_count();
    const V3f& here = scene.vertices[patch.vertices[corner]];
    const V3f to_next = (scene.vertices[patch.vertices[(corner + 1) % n]] - here).normalized();
    const V3f to_last = (scene.vertices[patch.vertices[(corner + n - 1) % n]] - here).normalized();
    return std::acos(std::clamp(to_next.dot(to_last), -1.0f, 1.0f));
}

}  // namespace

CornerGroups group_corners(const Scene& scene, const SmoothingOptions& options) {
    const float least_cosine = std::cos(options.crease_angle * std::numbers::pi_v<float> / 180);
    const std::vector<V3f> normals = patch_normals(scene);
    const auto smooth = [&](const PatchEdge& a, const PatchEdge& b) {
        return a.upwards != b.upwards && scene.patches[a.patch()].material == scene.patches[b.patch()].material &&
               normals[a.patch()].dot(normals[b.patch()]) >= least_cosine;
    };

    const std::vector<PatchEdge> edges = sorted_edges(scene);
    DisjointSets corners(4 * scene.patches.size());
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const PatchEdge& e) { return !e.same_place(*first); });
        if (static_cast<std::size_t>(last - first) <= most_patches_at_an_edge)
            for (auto a = first; a != last; ++a)
                for (auto b = a + 1; b != last; ++b)
                    if (smooth(*a, *b)) unite_across(*a, *b, corners);
        first = last;
    }
    return number_groups(scene, corners);
}

std::vector<Rgb> corner_means(const Scene& scene, const CornerGroups& groups, std::span<const Rgb> values) {
    std::vector<RgbD> sum(groups.count, RgbD(0, 0, 0));
    std::vector<double> weight(groups.count, 0.0);
    for (std::size_t p = 0; p < scene.patches.size(); ++p)
        for (int c = 0; c < scene.patches[p].vertex_count(); ++c) {
            const std::uint32_t group = groups.group[4 * p + c];
            const double angle = corner_angle(scene, scene.patches[p], c);
            sum[group] += RgbD(values[p]) * angle;
            weight[group] += angle;
        }
    std::vector<Rgb> means(groups.count, Rgb(0, 0, 0));
    for (std::size_t g = 0; g < means.size(); ++g)
        if (weight[g] > 0) means[g] = Rgb(sum[g] / weight[g]);
    return means;
}

SmoothIrradiance::SmoothIrradiance(const Scene& scene, std::span<const Rgb> irradiance,
                                   const SmoothingOptions& options) {
    if (irradiance.size() != scene.patches.size())
        throw InputError(fmt::format("irradiance has {} values, expected one for each of the scene's {} patches",
                                     irradiance.size(), scene.patches.size()));
    groups_ = group_corners(scene, options);
    corner_value_ = corner_means(scene, groups_, irradiance);
}

Rgb SmoothIrradiance::at(std::uint32_t patch, Parameters p) const {
    const auto corner = [&](std::size_t c) { return corner_value_[groups_.group[4 * std::size_t{patch} + c]]; };
    const bool triangle = groups_.group[4 * std::size_t{patch} + 3] == none;
    if (triangle) return corner(0) * (1 - p.u - p.v) + corner(1) * p.u + corner(2) * p.v;
    return (corner(0) * (1 - p.u) + corner(1) * p.u) * (1 - p.v) + (corner(3) * (1 - p.u) + corner(2) * p.u) * p.v;
}

}  // namespace interflect
