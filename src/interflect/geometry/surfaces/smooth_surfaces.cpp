#include "interflect/geometry/surfaces/smooth_surfaces.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/search/bounds.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/geometry/search/disjoint_sets.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

namespace {

/// Edges at which more patches meet count as creases.
constexpr std::size_t max_patches_at_an_edge = 64;

/// Distance of vertices that are welded, relative to the largest coordinate: eight float steps, which is more than the
/// rounding of a point on an edge.
constexpr float weld_share = 0x1p-20f;

float weld_tolerance(const Scene& scene) {
    const Imath::Box3f bounds = core_bounds(scene);
    float largest = 0;
    for (const V3f& p : {bounds.min, bounds.max})
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return weld_share * largest;
}

/// Grid that finds vertices close to each other. Its cells are four tolerances wide, so most searches visit only one.
class VertexGrid {
  public:
    explicit VertexGrid(const Scene& scene)
        : positions_(scene.vertices), next_(positions_.size(), none), tolerance_(weld_tolerance(scene)) {
        first_.reserve(positions_.size());
    }

    /// Returns an earlier vertex at the position of vertex i; otherwise adds vertex i and returns it.
    std::uint32_t weld(std::uint32_t i) {
        const GridCell low = cell_of(positions_[i] - V3f(tolerance_)), high = cell_of(positions_[i] + V3f(tolerance_));
        for (std::int64_t x = low.x; x <= high.x; ++x)
            for (std::int64_t y = low.y; y <= high.y; ++y)
                for (std::int64_t z = low.z; z <= high.z; ++z)
                    if (const std::uint32_t same = find_in({x, y, z}, positions_[i]); same != none) return same;
        const auto [entry, is_new] = first_.try_emplace(cell_of(positions_[i]), i);
        if (!is_new) next_[i] = std::exchange(entry->second, i);
        return i;
    }

  private:
    using GridCell = Imath::Vec3<std::int64_t>;
    struct CellHash {
        std::size_t operator()(const GridCell& c) const { return mix(mix(c.x, c.y), c.z); }
    };

    GridCell cell_of(const V3f& p) const {
        const double size = 4 * std::max(static_cast<double>(tolerance_), std::numeric_limits<double>::min());
        constexpr double last = 0x1p62;  // limits the index of a point far from the scene
        const auto index = [&](float v) {
            return static_cast<std::int64_t>(std::clamp(std::floor(v / size), -last, last));
        };
        return {index(p.x), index(p.y), index(p.z)};
    }
    std::uint32_t find_in(const GridCell& cell, const V3f& p) const {
        const auto entry = first_.find(cell);
        if (entry == first_.end()) return none;
        std::uint32_t i = entry->second;
        while (i != none && (positions_[i] - p).length() > tolerance_) i = next_[i];
        return i;
    }

    const std::vector<V3f>& positions_;
    std::unordered_map<GridCell, std::uint32_t, CellHash> first_;
    std::vector<std::uint32_t> next_;
    float tolerance_;  // [m]
};

std::vector<std::uint32_t> weld(const Scene& scene) {
    VertexGrid grid(scene);
    std::vector<std::uint32_t> welded(scene.vertices.size());
    for (std::uint32_t i = 0; i < welded.size(); ++i) welded[i] = grid.weld(i);
    return welded;
}

struct PatchEdge {
    std::uint32_t low, high;  // welded vertices, low < high
    CornerIndex start, end;
    bool upwards;  // whether the edge runs from `low` to `high`

    PatchIndex patch() const { return start.patch(); }
    friend bool operator<(const PatchEdge& a, const PatchEdge& b) {
        return std::tie(a.low, a.high, a.start) < std::tie(b.low, b.high, b.start);
    }
    bool same_place(const PatchEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<PatchEdge> sorted_patch_edges(const Scene& scene) {
    const std::vector<std::uint32_t> welded = weld(scene);
    std::vector<PatchEdge> edges;
    edges.reserve(4 * scene.patches.size());
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const Patch& patch = scene.patches[p];
        const auto corners = static_cast<std::uint32_t>(patch.vertex_count());
        for (std::uint32_t c = 0; c < corners; ++c) {
            const std::uint32_t next = (c + 1) % corners;
            const std::uint32_t from = welded[patch.vertices[c]], to = welded[patch.vertices[next]];
            edges.push_back(
                {std::min(from, to), std::max(from, to), CornerIndex(p, c), CornerIndex(p, next), from < to});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

class CreaseTest {
  public:
    CreaseTest(const Scene& scene, float crease_angle)
        : scene_(scene), normals_(patch_normals(scene)), min_cosine_(cosine_of(crease_angle)) {}

    bool is_smooth(PatchIndex p, PatchIndex q) const {
        return has_one_material(p, q) && normals_[p].dot(normals_[q]) >= min_cosine_;
    }
    /// Compares Scene::normals if all corners of the edge have them, else the patches' normals.
    bool is_smooth(const PatchEdge& a, const PatchEdge& b) const {
        const Comparison start = compare_normals(a.start, b.end), end = compare_normals(a.end, b.start);
        if (start == Comparison::unknown || end == Comparison::unknown) return is_smooth(a.patch(), b.patch());
        return start == Comparison::equal && end == Comparison::equal && has_one_material(a.patch(), b.patch()) &&
               normals_[a.patch()].dot(normals_[b.patch()]) >= min_cosine_of_smooth_;
    }

  private:
    enum class Comparison { unknown, equal, different };

    static float cosine_of(float degrees) { return std::cos(degrees * std::numbers::pi_v<float> / 180); }
    bool has_one_material(PatchIndex p, PatchIndex q) const {
        return scene_.patches[p].material == scene_.patches[q].material;
    }
    /// Returns the normal towards the lit side; zero if it is missing.
    V3f normal_at(CornerIndex corner) const {
        if (scene_.normals.empty()) return V3f(0);
        const V3f n = scene_.normals[scene_.patches[corner.patch()].vertices[corner.corner()]];
        return n.dot(normals_[corner.patch()]) < 0 ? -n : n;
    }
    Comparison compare_normals(CornerIndex corner, CornerIndex other) const {
        const V3f n = normal_at(corner), m = normal_at(other);
        if (n == V3f(0) || m == V3f(0)) return Comparison::unknown;
        return n.dot(m) >= cosine_of_equal_ ? Comparison::equal : Comparison::different;
    }

    const Scene& scene_;
    const std::vector<V3f> normals_;
    const float min_cosine_;
    // Normals within 1 degree count as equal, because readers round them by 0.2 degrees.
    const float cosine_of_equal_ = cosine_of(1);
    // An edge of more than 60 degrees is a crease, because some programs average normals even across the corners of
    // rooms.
    const float min_cosine_of_smooth_ = cosine_of(60);
};

SmoothSurfaces::Groups number_groups(const Scene& scene, DisjointSets& sets) {
    SmoothSurfaces::Groups groups;
    groups.group.assign(4 * scene.patches.size(), none);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(scene.patches[p].vertex_count()); ++c) {
            const std::uint32_t member = CornerIndex(p, c), first = sets.find(member);
            groups.group[member] = first == member ? groups.count++ : groups.group[first];
        }
    return groups;
}

/// Interval of distances along a line [m].
struct LineInterval {
    double from, to;
};

/// Returns the parts of `whole` outside `covered` that are longer than `least` [m].
std::vector<LineInterval> uncovered_parts(LineInterval whole, std::vector<LineInterval> covered, double least) {
    std::sort(covered.begin(), covered.end(),
              [](const LineInterval& a, const LineInterval& b) { return a.from < b.from; });
    std::vector<LineInterval> parts;
    covered.push_back({whole.to, whole.to});
    for (const LineInterval& c : covered) {
        if (std::min(c.from, whole.to) - whole.from > least) parts.push_back({whole.from, std::min(c.from, whole.to)});
        whole.from = std::max(whole.from, c.to);
    }
    return parts;
}

class StraightEdge {
  public:
    StraightEdge(const V3f& from, const V3f& to) : origin_(from), direction_(Imath::V3d(to) - Imath::V3d(from)) {
        length_ = direction_.length();
        direction_ /= length_;
    }
    double length() const { return length_; }
    double along(const V3f& x) const { return direction_.dot(Imath::V3d(x) - origin_); }
    double distance(const V3f& x) const {
        const Imath::V3d d = Imath::V3d(x) - origin_;
        return (d - direction_ * direction_.dot(d)).length();
    }
    bool is_collinear(const V3f& a, const V3f& b, double tolerance) const {
        return distance(a) <= tolerance && distance(b) <= tolerance;
    }
    /// Returns the part of the edge between a and b, which must be collinear with it.
    LineInterval part_between(const V3f& a, const V3f& b) const {
        const auto [low, high] = std::minmax({along(a), along(b)});
        return {std::max(0.0, low), std::min(length_, high)};
    }

  private:
    Imath::V3d origin_, direction_;
    double length_ = 0;
};

Imath::Box3f box_around(const V3f& a, const V3f& b, float margin) {
    Imath::Box3f box(a);
    box.extendBy(b);
    return widened(box, margin);
}

/// Finds segments that may be collinear with another and overlap it. Segments are in three trees, by the axis along
/// which they are longest; so segments that only meet at an angle are not visited.
class SegmentTrees {
  public:
    SegmentTrees(std::size_t count, const auto& ends_of) {
        boxes_.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto [a, b] = ends_of(i);
            boxes_.push_back(box_around(a, b, 0));
            trees_[boxes_.back().majorAxis()].push_back({boxes_.back(), i});
        }
        for (std::vector<Boxed>& tree : trees_) arrange_box_tree(tree);
    }
    void visit(const V3f& a, const V3f& b, float margin, const auto& body) const {
        constexpr float min_share = 0.25f;  // relative to the largest extent, because rounding turns short segments
        const V3f extent = box_around(a, b, 0).size();
        const float least = min_share * std::max({extent.x, extent.y, extent.z});
        const Imath::Box3f box = box_around(a, b, margin);
        for (unsigned axis = 0; axis < trees_.size(); ++axis)
            if (extent[static_cast<int>(axis)] >= least)
                visit_box_tree(
                    std::span<const Boxed>(trees_[axis]),
                    [&](const Imath::Box3f& other) { return other.intersects(box); },
                    [&](std::uint32_t i) {
                        if (boxes_[i].intersects(box)) body(i);
                    });
    }

  private:
    std::vector<Imath::Box3f> boxes_;
    std::array<std::vector<Boxed>, 3> trees_;
};

class ContactTree {
  public:
    explicit ContactTree(const Scene& scene)
        : contacts_(scene.contacts),
          tolerance_(weld_tolerance(scene)),
          trees_(scene.contacts.size(),
                 [&](std::uint32_t i) { return std::pair(scene.contacts[i].a, scene.contacts[i].b); }) {}

    /// Returns the parts of the segment ab along which contacts run.
    std::vector<LineInterval> along(const V3f& a, const V3f& b) const {
        const StraightEdge edge(a, b);
        std::vector<LineInterval> found;
        trees_.visit(a, b, tolerance_, [&](std::uint32_t i) {
            const Contact& c = contacts_[i];
            if (!edge.is_collinear(c.a, c.b, tolerance_)) return;
            const LineInterval part = edge.part_between(c.a, c.b);
            if (part.to - part.from > tolerance_) found.push_back(part);
        });
        return found;
    }

  private:
    const std::vector<Contact>& contacts_;
    float tolerance_;
    SegmentTrees trees_;
};

/// Minimum length of a seam, relative to the shorter edge. Shorter seams are gaps between consecutive walls.
constexpr double min_seam_share = 1e-3;
constexpr std::size_t edges_per_task = 256;

class SeamFinder {
  public:
    /// @param edges  Edges that are not joined along their whole length.
    SeamFinder(const Scene& scene, std::vector<PatchEdge> edges, const ContactTree& contacts)
        : scene_(scene),
          edges_(std::move(edges)),
          contacts_(contacts),
          tolerance_(weld_tolerance(scene)),
          trees_(edges_.size(), [&](std::uint32_t i) { return std::pair(start(edges_[i]), end(edges_[i])); }) {}

    std::vector<SmoothSurfaces::Seam> seams(const auto& smooth) const {
        std::vector<std::vector<SmoothSurfaces::Seam>> found((edges_.size() + edges_per_task - 1) / edges_per_task);
        parallel_for_ranges(edges_.size(), edges_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                add_seams(static_cast<std::uint32_t>(i), smooth, found[begin / edges_per_task]);
        });
        std::vector<SmoothSurfaces::Seam> all;
        for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
        return all;
    }

  private:
    void add_seams(std::uint32_t i, const auto& smooth, std::vector<SmoothSurfaces::Seam>& found) const {
        if (!is_piece(edges_[i])) return;
        std::vector<std::uint32_t> others;
        trees_.visit(start(edges_[i]), end(edges_[i]), tolerance_, [&](std::uint32_t j) {
            if (is_piece(edges_[j]) && j <= i) return;  // because the pair was found from the other side
            if (edges_[i].patch() != edges_[j].patch() && smooth(edges_[i].patch(), edges_[j].patch()))
                others.push_back(j);
        });
        std::sort(others.begin(), others.end());
        for (const std::uint32_t j : others) add_seams_between(edges_[i], edges_[j], found);
    }
    const V3f& position(CornerIndex corner) const {
        return scene_.vertices[scene_.patches[corner.patch()].vertices[corner.corner()]];
    }
    const V3f& start(const PatchEdge& e) const { return position(e.start); }
    const V3f& end(const PatchEdge& e) const { return position(e.end); }
    bool is_piece(const PatchEdge& e) const { return scene_.patches[e.patch()].surface != none; }

    void add_seams_between(const PatchEdge& a, const PatchEdge& b, std::vector<SmoothSurfaces::Seam>& found) const {
        const StraightEdge line(start(a), end(a)), other(start(b), end(b));
        if (line.length() >= other.length() ? !line.is_collinear(start(b), end(b), tolerance_)
                                            : !other.is_collinear(start(a), end(a), tolerance_))
            return;
        const double b_start = line.along(start(b)), b_end = line.along(end(b));
        if (b_end >= b_start) return;  // edges of neighbours run in opposite directions
        const LineInterval shared{std::max(0.0, b_end), std::min(line.length(), b_start)};
        const double least = std::max(2.0 * tolerance_, min_seam_share * std::min(line.length(), other.length()));
        if (shared.to - shared.from <= least) return;
        for (const LineInterval& part : uncovered_parts(shared, contacts_.along(start(a), end(a)), least)) {
            const auto on_a = [&](double x) { return snapped(x / line.length(), line.length()); };
            const auto on_b = [&](double x) { return snapped((b_start - x) / (b_start - b_end), other.length()); };
            found.push_back({{a.start, b.start}, {on_a(part.from), on_b(part.to)}, {on_a(part.to), on_b(part.from)}});
        }
    }
    /// Returns the parameter, or exactly 0 or 1 if it is close to an end.
    float snapped(double parameter, double length) const {
        const double margin = tolerance_ / length;
        return static_cast<float>(parameter <= margin ? 0 : parameter >= 1 - margin ? 1 : parameter);
    }

    const Scene& scene_;
    const std::vector<PatchEdge> edges_;
    const ContactTree& contacts_;
    float tolerance_;
    SegmentTrees trees_;
};

}  // namespace

std::vector<V3f> patch_normals(const Scene& scene) {
    std::vector<V3f> normals;
    normals.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) normals.push_back(PatchGeometry(scene, patch).normal());
    return normals;
}

SmoothSurfaces find_smooth_surfaces(const Scene& scene, const SmoothingOptions& options) {
    const CreaseTest creases(scene, options.crease_angle);
    const ContactTree contacts(scene);
    const std::vector<PatchEdge> edges = sorted_patch_edges(scene);

    // Find edges of cut faces along which contacts run
    std::vector<std::uint8_t> has_contact(edges.size(), 0);
    parallel_for_ranges(edges.size(), edges_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Patch& patch = scene.patches[edges[i].patch()];
            if (patch.surface == none) continue;
            const V3f &from = scene.vertices[patch.vertices[edges[i].start.corner()]],
                      &to = scene.vertices[patch.vertices[edges[i].end.corner()]];
            has_contact[i] = !contacts.along(from, to).empty();
        }
    });

    // Join patches across common whole edges
    DisjointSets joined_corners(4 * scene.patches.size()), joined_edges(4 * scene.patches.size());
    std::vector<bool> is_joined(4 * scene.patches.size(), false);
    const auto join = [&](const PatchEdge& a, const PatchEdge& b) {
        joined_corners.unite(a.start, b.end);
        joined_corners.unite(a.end, b.start);
        joined_edges.unite(a.start, b.start);
        is_joined[a.start] = is_joined[b.start] = true;
    };
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const PatchEdge& e) { return !e.same_place(*first); });
        const auto contact = has_contact.begin() + (first - edges.begin());
        const bool may_continue =
            static_cast<std::size_t>(last - first) <= max_patches_at_an_edge &&
            std::none_of(contact, contact + (last - first), [](std::uint8_t x) { return x != 0; });
        if (may_continue)
            for (auto a = first; a != last; ++a)
                for (auto b = a + 1; b != last; ++b)
                    if (a->upwards != b->upwards && creases.is_smooth(*a, *b)) join(*a, *b);
        first = last;
    }

    // Join pieces of cut faces across common parts of the remaining edges
    std::vector<SmoothSurfaces::Seam> seams;
    if (std::any_of(scene.patches.begin(), scene.patches.end(), [](const Patch& p) { return p.surface != none; })) {
        std::vector<PatchEdge> open;
        std::copy_if(edges.begin(), edges.end(), std::back_inserter(open),
                     [&](const PatchEdge& e) { return !is_joined[e.start]; });
        const auto next_corner = [&](CornerIndex corner) {
            const auto corners = static_cast<std::uint32_t>(scene.patches[corner.patch()].vertex_count());
            return CornerIndex(corner.patch(), (corner.corner() + 1) % corners);
        };
        seams = SeamFinder(scene, std::move(open), contacts).seams([&](PatchIndex p, PatchIndex q) {
            return creases.is_smooth(p, q);
        });
        for (const auto& [edge, from, to] : seams) {
            if (from[0] == 0 && to[1] == 1) joined_corners.unite(edge[0], next_corner(edge[1]));
            if (to[0] == 1 && from[1] == 0) joined_corners.unite(next_corner(edge[0]), edge[1]);
        }
    }
    return {number_groups(scene, joined_corners), number_groups(scene, joined_edges), std::move(seams)};
}

}  // namespace interflect::detail
