#include "interflect/exports/charts/charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "interflect/exports/charts/layouts.h"
#include "interflect/exports/charts/unfolding.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/search/box_tree.h"
#include "interflect/geometry/surfaces/flat_surfaces.h"
#include "interflect/geometry/surfaces/smooth_surfaces.h"

namespace interflect::detail {

namespace {

/// Gaps narrower than this separate charts [texels].
constexpr double narrow_gap = 2;

/// Part of an edge that has no adjacent patch.
struct BorderEdge {
    PatchIndex patch;
    V3f a, b;
    V3f inwards;  // unit vector in the plane of the patch
};

/// Returns the joints of smooth surfaces, except joints between objects.
Joints joints_of(const Scene& scene, const SmoothSurfaces& smooth) {
    Joints joints = smooth.seams;
    std::vector<EdgeIndex> first(smooth.edges.count);
    for (std::size_t i = 0; i < smooth.edges.group.size(); ++i) {
        const EdgeIndex edge(i);
        const std::uint32_t group = smooth.edges.group[edge];
        if (group == none) continue;
        if (first[group] == none)
            first[group] = edge;
        else
            joints.push_back({{first[group], edge}, {0, 0}, {1, 1}});
    }
    std::erase_if(joints, [&](const SmoothSurfaces::Seam& joint) {
        return scene.patches[joint.edge[0].patch()].object != scene.patches[joint.edge[1].patch()].object;
    });
    return joints;
}

/// Neighbours of each patch on the same flat surface, and the border edges of these surfaces.
class Neighbourhood {
  public:
    Neighbourhood(const Scene& scene, const Joints& joints)
        : scene_(scene), neighbours_(scene.patches.size()), surface_(flat_surfaces(scene)) {
        std::vector<Intervals> shared(4 * scene.patches.size());
        for (const auto& joint : joints) {
            const PatchIndex p = joint.edge[0].patch(), q = joint.edge[1].patch();
            if (surface_side(p) != surface_side(q)) continue;
            neighbours_[p].push_back(q);
            neighbours_[q].push_back(p);
            for (std::size_t k = 0; k < 2; ++k) shared[joint.edge[k]].emplace_back(joint.from[k], joint.to[k]);
        }
        for (PatchIndex p{0}; p < scene.patches.size(); ++p)
            for (int c = 0; c < scene.patches[p].vertex_count(); ++c) {
                const EdgeIndex edge(p, static_cast<std::uint32_t>(c));
                add_border(edge, shared[edge]);
            }
    }

    /// Returns a number that identifies a side of a flat surface.
    std::uint64_t surface_side(PatchIndex p) const {
        const bool is_back = scene_.patches[p].other_side < p;
        return std::uint64_t{surface_[p]} << 1 | static_cast<std::uint64_t>(is_back);
    }
    const std::vector<PatchIndex>& neighbours(PatchIndex patch) const { return neighbours_[patch]; }
    const std::vector<BorderEdge>& border() const { return border_; }

  private:
    using Intervals = std::vector<std::pair<float, float>>;

    /// Adds the parts of an edge outside the intervals that it shares with neighbours.
    void add_border(EdgeIndex edge, Intervals shared) {
        constexpr float rounding = 1e-5f;
        const Patch& patch = scene_.patches[edge.patch()];
        const int corner = static_cast<int>(edge.corner());
        const V3f& start = scene_.vertices[patch.vertices[corner]];
        const V3f along = scene_.vertices[patch.vertices[(corner + 1) % patch.vertex_count()]] - start;
        const V3f inwards = PatchGeometry(scene_, patch).normal().cross(along).normalized();
        std::sort(shared.begin(), shared.end());
        shared.emplace_back(1.0f, 1.0f);
        float end = 0;
        for (const auto& [low, high] : shared) {
            if (low > end + rounding)
                border_.push_back({edge.patch(), start + end * along, start + low * along, inwards});
            end = std::max(end, high);
        }
    }

    const Scene& scene_;
    PerPatch<std::vector<PatchIndex>> neighbours_;
    std::vector<std::uint32_t> surface_;
    std::vector<BorderEdge> border_;
};

float distance(const V3f& x, const BorderEdge& edge) {
    const V3f along = edge.b - edge.a;
    const float t = std::clamp((x - edge.a).dot(along) / along.length2(), 0.0f, 1.0f);
    return (x - edge.a - t * along).length();
}

bool are_across_a_gap(const BorderEdge& e, const BorderEdge& f, float gap) {
    constexpr float opposite_cosine = -0.5f;
    if (!(e.inwards.dot(f.inwards) < opposite_cosine)) return false;
    const V3f between_middles = (f.a + f.b) / 2 - (e.a + e.b) / 2;
    const float rounding = 1e-3f * gap;
    // The gap must be outside both patches.
    if (e.inwards.dot(between_middles) > rounding || f.inwards.dot(between_middles) < -rounding) return false;
    // Edges that only touch at a corner enclose no gap.
    const V3f along = (e.b - e.a).normalized();
    const float length = (e.b - e.a).length(), s = along.dot(f.a - e.a), t = along.dot(f.b - e.a);
    const float overlap = std::min(length, std::max(s, t)) - std::max(0.0f, std::min(s, t));
    if (!(overlap > rounding)) return false;
    return std::min({distance(e.a, f), distance(e.b, f), distance(f.a, e), distance(f.b, e)}) < gap;
}

void add_conflicts(std::span<const BorderEdge> border, float gap, ChartConflicts& conflicts) {
    const auto box_of = [](const BorderEdge& edge, float margin) {
        Imath::Box3f box(edge.a);
        box.extendBy(edge.b);
        return Imath::Box3f(box.min - V3f(margin), box.max + V3f(margin));
    };
    std::vector<Boxed> tree;
    for (std::uint32_t i = 0; i < border.size(); ++i) tree.push_back({box_of(border[i], 0), i});
    arrange_box_tree(tree);
    for (const BorderEdge& edge : border) {
        const auto is_near = [reach = box_of(edge, gap)](const Imath::Box3f& box) { return box.intersects(reach); };
        visit_box_tree(std::span<const Boxed>(tree), is_near, [&](std::uint32_t j) {
            if (border[j].patch != edge.patch && are_across_a_gap(edge, border[j], gap))
                conflicts[edge.patch].push_back(border[j].patch);
        });
    }
}

ChartConflicts find_conflicts(const Scene& scene, const Neighbourhood& neighbourhood, double gap) {
    std::vector<BorderEdge> border = neighbourhood.border();
    const auto side = [&](const BorderEdge& edge) { return neighbourhood.surface_side(edge.patch); };
    std::stable_sort(border.begin(), border.end(),
                     [&](const BorderEdge& a, const BorderEdge& b) { return side(a) < side(b); });
    ChartConflicts conflicts(scene.patches.size());
    for (auto first = border.begin(); first != border.end();) {
        const auto end =
            std::find_if(first, border.end(), [&](const BorderEdge& edge) { return side(edge) != side(*first); });
        add_conflicts(std::span<const BorderEdge>(first, end), static_cast<float>(gap), conflicts);
        first = end;
    }
    return conflicts;
}

/// Grows connected pieces of flat surfaces, breadth-first, from patches without conflicts.
std::vector<FlatPatches> flat_pieces(const Scene& scene, const std::vector<bool>& shown,
                                     const Neighbourhood& neighbourhood, const ChartConflicts& conflicts) {
    std::vector<std::uint32_t> piece_of(scene.patches.size(), none);
    std::vector<FlatPatches> pieces;
    for (PatchIndex seed{0}; seed < piece_of.size(); ++seed) {
        if (piece_of[seed] != none || !shown[seed]) continue;
        const auto number = static_cast<std::uint32_t>(pieces.size());
        std::vector<PatchIndex> group{seed};
        piece_of[seed] = number;
        for (std::size_t i = 0; i < group.size(); ++i)
            for (const PatchIndex next : neighbourhood.neighbours(group[i])) {
                const auto is_here = [&](PatchIndex other) { return piece_of[other] == number; };
                if (piece_of[next] != none || !shown[next] ||
                    std::any_of(conflicts[next].begin(), conflicts[next].end(), is_here))
                    continue;
                piece_of[next] = number;
                group.push_back(next);
            }
        pieces.push_back(projected(scene, group));
    }
    return pieces;
}

using Points = std::vector<Imath::V2d>;

/// Returns the convex hull, counter-clockwise, by Andrew's monotone chain (1979).
Points hull_of_chart(Points points) {
    std::sort(points.begin(), points.end(),
              [](const auto& a, const auto& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
    Points hull;
    const auto add_chain = [&](auto begin, auto end) {
        const std::size_t first = hull.size();
        for (auto p = begin; p != end; ++p) {
            while (hull.size() >= first + 2 && (hull.back() - hull[hull.size() - 2]).cross(*p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(*p);
        }
        hull.pop_back();
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
    return hull;
}

struct Rectangle {
    Imath::V2d corner, across;  // `across` is the unit vector along size.x
    Imath::V2d size;
};

/// Returns the smallest enclosing rectangle. One of its sides contains an edge of the hull (Freeman and Shapira 1975).
Rectangle smallest_rectangle(const Points& hull) {
    Rectangle best;
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Imath::V2d edge = hull[(i + 1) % hull.size()] - hull[i];
        if (!(edge.length() > 0)) continue;
        const Imath::V2d x = edge.normalized(), y(-x.y, x.x);
        Imath::V2d low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
        for (const Imath::V2d& p : hull) {
            const Imath::V2d q(p.dot(x), p.dot(y));
            low = {std::min(low.x, q.x), std::min(low.y, q.y)};
            high = {std::max(high.x, q.x), std::max(high.y, q.y)};
        }
        const Imath::V2d size = high - low;
        constexpr double rounding = 1e-6;
        if (size.x * size.y < least * (1 - rounding)) {
            least = size.x * size.y;
            best = {x * low.x + y * low.y, x, size};
        }
    }
    return best;
}

int texels_along(double length, double texels_per_metre, int most) {
    constexpr double rounding = 1e-3;  // [texels]
    const double count = std::ceil(length * texels_per_metre - rounding) + 1;
    return static_cast<int>(std::clamp(count, 2.0, static_cast<double>(most)));
}

/// Makes a chart. The smallest coordinates of the patches must be 0.
LightmapChart chart_of(const Scene& scene, FlatPatches patches, const LightmapOptions& options) {
    LightmapChart chart{std::move(patches), {0, 0}};
    for (const FlatPatch& flat : chart.patches)
        for (const Imath::V2d& corner : flat.outline())
            chart.size = {std::max(chart.size.x, corner.x), std::max(chart.size.y, corner.y)};
    const int most = options.max_size - 2 * options.gutter;
    const PatchIndex first = chart.patches.front().patch;
    chart.requested_density = density_of(scene, first, options);
    chart.columns = texels_along(chart.size.x, chart.requested_density, most);
    chart.rows = texels_along(chart.size.y, chart.requested_density, most);
    chart.object = scene.patches[first].object;
    chart.is_updated = std::any_of(chart.patches.begin(), chart.patches.end(), [&](const FlatPatch& flat) {
        const Patch& patch = scene.patches[flat.patch];
        return is_updated(scene.objects[patch.object], scene.materials[patch.material].name, options);
    });
    return chart;
}

FlatPatches moved_into(const Rectangle& rectangle, FlatPatches patches) {
    for (FlatPatch& flat : patches)
        for (Imath::V2d& corner : flat.corners) {
            const Imath::V2d offset = corner - rectangle.corner;
            corner = {offset.dot(rectangle.across), rectangle.across.cross(offset)};
        }
    return patches;
}

Points corners_of(const FlatPatches& patches) {
    Points points;
    for (const FlatPatch& flat : patches) points.insert(points.end(), flat.outline().begin(), flat.outline().end());
    return points;
}

Rectangle bounding_rectangle(const FlatPatches& patches) {
    Imath::Box2d box;
    for (const FlatPatch& flat : patches) box.extendBy(flat.box());
    return {box.min, {1, 0}, box.size()};
}

std::vector<FlatPatches> smooth_layouts(const Scene& scene, const std::vector<bool>& shown, double gap) {
    const SmoothSurfaces smooth = find_smooth_surfaces(scene);
    const Joints joints = joints_of(scene, smooth);
    const Neighbourhood neighbourhood(scene, joints);
    const ChartConflicts conflicts = find_conflicts(scene, neighbourhood, gap);
    return unfolded(scene, smooth.corners, joints, conflicts, flat_pieces(scene, shown, neighbourhood, conflicts), gap);
}

bool matches_surface(const std::string& pattern, const std::string& object, const std::string& material) {
    return matches_object(pattern, object) || matches(pattern, material);
}

}  // namespace

bool is_updated(const std::string& object, const std::string& material, const LightmapOptions& options) {
    return options.update.empty() ||
           std::any_of(options.update.begin(), options.update.end(),
                       [&](const std::string& pattern) { return matches_surface(pattern, object, material); });
}

float density_of(const Scene& scene, PatchIndex patch, const LightmapOptions& options) {
    const std::string& object = scene.objects[scene.patches[patch].object];
    const std::string& material = scene.materials[scene.patches[patch].material].name;
    for (const auto& [pattern, texels_per_metre] : options.densities)
        if (matches_surface(pattern, object, material)) return texels_per_metre;
    return options.texels_per_metre;
}

V2f LightmapChart::coordinate(const Imath::V2d& at, const std::vector<Image>& images) const {
    const Image& image = images[static_cast<std::size_t>(page)];
    const Imath::V2d texel = at / spacing();
    return {static_cast<float>((left + texel.x + 0.5) / image.width),
            static_cast<float>((top + texel.y + 0.5) / image.height)};
}

std::vector<LightmapChart> make_charts(const Scene& scene, std::vector<bool> shown, const LightmapOptions& options,
                                       Warnings* warnings) {
    std::vector<LightmapChart> charts;
    if (!options.own_charts)
        for (FlatPatches& layout : kept_layouts(scene, shown, warnings)) {
            for (const FlatPatch& flat : layout) shown[flat.patch] = false;
            const Rectangle rectangle = bounding_rectangle(layout);
            charts.push_back(chart_of(scene, moved_into(rectangle, std::move(layout)), options));
        }
    for (FlatPatches& layout : smooth_layouts(scene, shown, narrow_gap / options.texels_per_metre)) {
        const Rectangle rectangle = smallest_rectangle(hull_of_chart(corners_of(layout)));
        charts.push_back(chart_of(scene, moved_into(rectangle, std::move(layout)), options));
    }
    return charts;
}

}  // namespace interflect::detail
