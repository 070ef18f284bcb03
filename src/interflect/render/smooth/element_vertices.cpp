#include "interflect/render/smooth/element_vertices.h"

#include <algorithm>
#include <bit>
#include <numbers>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "interflect/base/numbers/random.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

using Corners = std::array<std::uint32_t, 4>;

std::uint32_t corner_count(const Corners& corners) { return corners[3] == none ? 3 : 4; }

/// Corners of each child, as points of the parent: 0 to 3 are its corners, 4 + c is the midpoint of the edge that
/// starts at corner c, and 8 is its centre.
using ChildCorners = std::array<std::array<std::uint32_t, 4>, 4>;
constexpr ChildCorners quadrilateral_children{{{0, 4, 8, 7}, {4, 1, 5, 8}, {7, 8, 6, 3}, {8, 5, 2, 6}}};
constexpr ChildCorners triangle_children{{{0, 4, 6, 3}, {4, 1, 5, 3}, {6, 5, 2, 3}, {5, 6, 4, 3}}};

/// Hash table from keys of edges to vertices, with open addressing. It is several times faster here than
/// std::unordered_map.
class KeyTable {
  public:
    explicit KeyTable(std::size_t max_keys) : entries_(std::bit_ceil(max_keys + max_keys / 2 + 1)) {}

    std::uint32_t find(std::uint64_t key) const { return entries_[slot(key)].vertex; }
    std::uint32_t find_or_insert(std::uint64_t key, std::uint32_t vertex) {
        TableEntry& entry = entries_[slot(key)];
        if (entry.vertex == none) entry = {key, vertex};
        return entry.vertex;
    }

  private:
    struct TableEntry {
        std::uint64_t key = 0;
        std::uint32_t vertex = none;
    };

    std::size_t slot(std::uint64_t key) const {
        const std::size_t mask = entries_.size() - 1;
        std::size_t i = mix(key, 0) & mask;
        while (entries_[i].vertex != none && entries_[i].key != key) i = (i + 1) & mask;
        return i;
    }

    std::vector<TableEntry> entries_;
};

/// Numbers the vertices of all elements, and finds the vertices inside edges of leaves.
class VertexBuilder {
  public:
    VertexBuilder(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options)
        : forest_(forest),
          surfaces_(find_smooth_surfaces(scene, options)),
          corners_(forest.size()),
          // A parent has at most four midpoints, and four children, so there are at most as many midpoints as children.
          middles_(forest.size() - forest.patch_count()) {
        edges_of_.assign(surfaces_.corners.count, no_edge);
        for (PatchIndex p{0}; p < forest.patch_count(); ++p)
            for (std::uint32_t c = 0; c < 4; ++c) corners_[p][c] = surfaces_.corners.group[CornerIndex(p, c)];
        for (ElementIndex e{0}; e < forest.size(); ++e)
            if (!forest.is_leaf(e)) add_vertices_of_children(e);
    }

    std::uint32_t count() const { return static_cast<std::uint32_t>(edges_of_.size()); }

    void find_hanging_vertices(std::vector<ElementVertices::Hanging>& hanging,
                               std::vector<ElementVertices::Coupling>& couplings) const {
        find_vertices_on_seams(hanging, couplings);
        std::vector<bool> hangs(count(), false);
        for (ElementIndex e{0}; e < forest_.size(); ++e)
            if (forest_.is_leaf(e)) mark_middles_of_edges(e, hangs);
        for (std::uint32_t v = surfaces_.corners.count; v < count(); ++v) {
            hangs[v] = hangs[v] || is_on_half_of_leaf_edge(v, hangs);
            if (hangs[v]) hanging.push_back({v, edges_of_[v]});
        }
    }

    const SmoothSurfaces& surfaces() const { return surfaces_; }
    std::vector<Corners> release_corners() { return std::move(corners_); }

  private:
    using Ends = std::array<std::uint32_t, 2>;
    static constexpr Ends no_edge{none, none};  // corners of patches and centres of elements are on no halved edge

    Ends ends_of_edge(ElementIndex e, std::uint32_t c) const {
        const Corners& corners = corners_[e];
        const std::uint32_t a = corners[c], b = corners[(c + 1) % corner_count(corners)];
        return {std::min(a, b), std::max(a, b)};
    }
    /// Edges of patches use their group as key, because two edges at a crease can have the same ends but different
    /// midpoints.
    std::uint64_t edge_key(ElementIndex e, std::uint32_t c) const {
        const auto key = [](std::uint64_t low, std::uint64_t high) { return high << 32 | low; };
        if (e < forest_.patch_count()) return key(surfaces_.edges.group[4 * e + c], surfaces_.edges.group[4 * e + c]);
        const Ends ends = ends_of_edge(e, c);
        return key(ends[0], ends[1]);
    }

    std::uint32_t add_vertex(Ends ends) {
        edges_of_.push_back(ends);
        return count() - 1;
    }
    std::uint32_t middle_of_edge(ElementIndex e, std::uint32_t c) {
        const std::uint32_t middle = middles_.find_or_insert(edge_key(e, c), count());
        if (middle == count()) add_vertex(ends_of_edge(e, c));
        return middle;
    }
    void add_vertices_of_children(ElementIndex e) {
        const Corners& corners = corners_[e];
        std::array<std::uint32_t, 9> vertex{};
        std::copy(corners.begin(), corners.end(), vertex.begin());
        const bool triangle = corners[3] == none;
        for (std::uint32_t c = 0; c < corner_count(corners); ++c) vertex[4 + c] = middle_of_edge(e, c);
        if (!triangle) vertex[8] = add_vertex(no_edge);
        const ElementIndex child = forest_.first_child(e);
        for (std::uint32_t k = 0; k < 4; ++k)
            for (std::uint32_t c = 0; c < 4; ++c)
                corners_[child + k][c] = vertex[(triangle ? triangle_children : quadrilateral_children)[k][c]];
    }

    void mark_middles_of_edges(ElementIndex leaf, std::vector<bool>& hangs) const {
        for (std::uint32_t c = 0; c < corner_count(corners_[leaf]); ++c)
            if (const std::uint32_t middle = middles_.find(edge_key(leaf, c)); middle != none) hangs[middle] = true;
    }
    /// Whether v is the middle of one half of a leaf edge: the half ends at the vertex that hangs in the middle of
    /// that edge. Requires the final values of `hangs` for all vertices before v.
    bool is_on_half_of_leaf_edge(std::uint32_t v, const std::vector<bool>& hangs) const {
        const auto [end, later_end] = edges_of_[v];
        return later_end != none && hangs[later_end] &&
               (edges_of_[later_end][0] == end || edges_of_[later_end][1] == end);
    }

    /// Edge of a leaf that lies on an edge of its patch.
    struct LeafEdge {
        std::array<std::uint32_t, 2> vertices;
        std::array<float, 2> at;  // positions along the patch edge in [0, 1], ascending

        float size() const { return at[1] - at[0]; }
    };

    /// Collects the leaf edges that overlap the interval [from, to] of the patch's edge. Edge c of element e covers
    /// [low, high].
    void collect_leaf_edges(ElementIndex e, std::uint32_t c, float low, float high, float from, float to,
                            std::vector<LeafEdge>& found) const {
        if (high <= from || low >= to) return;
        const std::uint32_t corners = corner_count(corners_[e]), next = (c + 1) % corners;
        if (forest_.is_leaf(e)) {
            found.push_back({{corners_[e][c], corners_[e][next]}, {low, high}});
            return;
        }
        constexpr std::array<std::uint32_t, 4> child_at_corner{0, 1, 3, 2};
        const auto child = [&](std::uint32_t corner) {
            return forest_.first_child(e) + (corners == 3 ? corner : child_at_corner[corner]);
        };
        const float middle = (low + high) / 2;
        collect_leaf_edges(child(c), c, low, middle, from, to, found);
        collect_leaf_edges(child(next), c, middle, high, from, to, found);
    }

    struct SeamSide {
        std::vector<LeafEdge> leaves;
        float length;  // length of the whole patch edge [m]
    };
    using SeamSides = std::array<SeamSide, 2>;

    SeamSides sides_of(const SmoothSurfaces::Seam& seam) const {
        SeamSides sides;
        for (std::size_t k = 0; k < 2; ++k) {
            const PatchIndex patch = seam.edge[k].patch();
            const std::uint32_t corner = seam.edge[k].corner();
            collect_leaf_edges(patch, corner, 0, 1, seam.from[k], seam.to[k], sides[k].leaves);
            const PatchGeometry& geometry = forest_.geometry(patch);
            const std::span<const Parameters> corners = corners_of(geometry.is_triangle());
            const V3f start = geometry.point(corners[corner]),
                      end = geometry.point(corners[(corner + 1) % corners.size()]);
            sides[k].length = (end - start).length();
        }
        return sides;
    }

    struct SeamVertex {
        std::uint32_t vertex;
        std::array<std::uint32_t, 2> ends;
        float fraction;
        float angle;        // angle at the vertex on its side of the seam [rad]
        float edge_length;  // distance from ends[0] to ends[1] [m]
    };

    /// Finds the leaf edge of the other side around each vertex on side k of the seam.
    static void add_seam_vertices(const SmoothSurfaces::Seam& seam, const SeamSides& sides, std::size_t k,
                                  std::vector<SeamVertex>& found) {
        constexpr float margin = 1e-5f;  // for rounding of positions along the patch edge
        const std::size_t other = 1 - k;
        const auto& leaves = sides[other].leaves;
        const auto add = [&](std::uint32_t vertex, float at) {
            if (at < seam.from[k] - margin || at > seam.to[k] + margin) return;
            const bool is_end = at < seam.from[k] + margin || at > seam.to[k] - margin;
            // Both sides run in opposite directions
            const float along_seam = std::clamp((at - seam.from[k]) / (seam.to[k] - seam.from[k]), 0.0f, 1.0f);
            const float at_other = seam.to[other] + along_seam * (seam.from[other] - seam.to[other]);
            const auto leaf =
                std::find_if(leaves.begin(), leaves.end(), [&](const LeafEdge& l) { return at_other <= l.at[1]; });
            if (leaf == leaves.end() || leaf->vertices[0] == vertex || leaf->vertices[1] == vertex) return;
            constexpr float pi = std::numbers::pi_v<float>;
            found.push_back({vertex, leaf->vertices, std::clamp((at_other - leaf->at[0]) / leaf->size(), 0.0f, 1.0f),
                             is_end ? pi / 2 : pi, leaf->size() * sides[other].length});
        };
        for (const LeafEdge& leaf : sides[k].leaves) add(leaf.vertices[0], leaf.at[0]);
        if (!sides[k].leaves.empty()) add(sides[k].leaves.back().vertices[1], sides[k].leaves.back().at[1]);
    }

    void find_vertices_on_seams(std::vector<ElementVertices::Hanging>& hanging,
                                std::vector<ElementVertices::Coupling>& couplings) const {
        std::vector<SeamVertex> found;
        std::unordered_map<std::uint32_t, float> longest_own;  // longest leaf edge at each vertex [m]
        for (const SmoothSurfaces::Seam& seam : surfaces_.seams) {
            const SeamSides sides = sides_of(seam);
            for (std::size_t k = 0; k < 2; ++k) {
                add_seam_vertices(seam, sides, k, found);
                for (const LeafEdge& leaf : sides[k].leaves)
                    for (const std::uint32_t v : leaf.vertices) {
                        float& longest = longest_own[v];
                        longest = std::max(longest, leaf.size() * sides[k].length);
                    }
            }
        }
        // The ends of an edge can hang only on longer edges. Sorted by length, they precede the vertices on the edge.
        std::stable_sort(found.begin(), found.end(),
                         [](const SeamVertex& a, const SeamVertex& b) { return a.edge_length > b.edge_length; });
        constexpr float clearly_longer = 1.01f;
        std::unordered_set<std::uint32_t> hangs;
        for (const SeamVertex& v : found)
            if (v.edge_length > clearly_longer * longest_own[v.vertex] && hangs.insert(v.vertex).second)
                hanging.push_back({v.vertex, v.ends, v.fraction});
        // The other vertices are coupled; each has a total share of 1/2
        std::unordered_map<std::uint32_t, float> angle;  // sum of the angles of all couplings of a vertex
        for (const SeamVertex& v : found) angle[v.vertex] += v.angle;
        for (const SeamVertex& v : found)
            if (!hangs.contains(v.vertex))
                couplings.push_back({v.vertex, v.ends, v.fraction, v.angle / (2 * angle[v.vertex])});
    }

    const ElementForest& forest_;
    const SmoothSurfaces surfaces_;
    std::vector<Corners> corners_;
    std::vector<Ends> edges_of_;  // for each vertex, the ends of the edge that it halves, or no_edge
    KeyTable middles_;            // vertex in the middle of each divided edge
};

}  // namespace

ElementVertices::ElementVertices(const Scene& scene, const ElementForest& forest, const SmoothingOptions& options) {
    forest.require_made_for(scene);
    VertexBuilder builder(scene, forest, options);
    count_ = builder.count();
    builder.find_hanging_vertices(hanging_, couplings_);
    normals_ = SmoothNormals(scene, builder.surfaces());
    corners_ = builder.release_corners();
}

}  // namespace interflect::detail
