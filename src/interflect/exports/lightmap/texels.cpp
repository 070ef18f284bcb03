#include "interflect/exports/lightmap/texels.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <limits>

#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/search/box_tree.h"

namespace interflect::detail {

namespace {

/// Returns the two sides of a texel in the parameters of the patch, by Cramer's rule. The patch is treated as the
/// parallelogram of its edges at corner 0.
/// @param spacing  Width and height of a texel [m].
std::array<Parameters, 2> texel_sides(const FlatPatch& flat, const Imath::V2d& spacing) {
    const Imath::V2d u = flat.corners[1] - flat.corners[0],
                     v = flat.corners[static_cast<std::size_t>(flat.count) - 1] - flat.corners[0];
    const double area = u.cross(v);
    const auto parameters = [&](const Imath::V2d& side) {
        return Parameters{static_cast<float>(side.cross(v) / area), static_cast<float>(u.cross(side) / area)};
    };
    return {parameters({spacing.x, 0}), parameters({0, spacing.y})};
}

class NearestPatch {
  public:
    explicit NearestPatch(const LightmapChart& chart) : patches_(chart.patches) {
        for (std::uint32_t i = 0; i < patches_.size(); ++i) {
            geometries_.push_back(geometry_of(patches_[i]));
            sides_.push_back(texel_sides(patches_[i], chart.spacing()));
            const PatchGeometry& geometry = geometries_.back();
            Imath::Box3f box;
            for (const Parameters p : {Parameters{0, 0}, {1, 0}, {0, 1}}) box.extendBy(geometry.point(p));
            if (!geometry.is_triangle()) box.extendBy(geometry.point({1, 1}));
            tree_.push_back({box, i});
        }
        arrange_box_tree(tree_);
    }

    /// Returns the place on the patches that is nearest to a point of the chart.
    /// @param at          Position in the chart [m].
    /// @param texel_size  Larger side of a texel [m].
    TexelPlace find(const Imath::V2d& at, float texel_size) const {
        const V3f x(static_cast<float>(at.x), static_cast<float>(at.y), 0);
        TexelPlace nearest;
        float least2 = std::numeric_limits<float>::max();
        const auto is_near = [&](const Imath::Box3f& box) {
            return (Imath::closestPointInBox(x, box) - x).length2() <= least2;
        };
        visit_box_tree(std::span<const Boxed>(tree_), is_near, [&](std::uint32_t i) {
            const Parameters p = nearest_parameters(geometries_[i], x);
            const float distance2 = (geometries_[i].point(p) - x).length2();
            const bool precedes = nearest.patch == none || patches_[i].patch < nearest.patch;
            if (distance2 < least2 || (distance2 == least2 && precedes)) {
                least2 = distance2;
                nearest = {{patches_[i].patch, p, sides_[i]}};
            }
        });
        constexpr float rounding = 1e-3f;  // [texels]
        nearest.is_inside = least2 <= rounding * rounding * texel_size * texel_size;
        nearest.is_near = least2 < (1 - rounding) * (1 - rounding) * texel_size * texel_size;
        return nearest;
    }

  private:
    static PatchGeometry geometry_of(const FlatPatch& flat);
    static Parameters nearest_parameters(const PatchGeometry& geometry, const V3f& x);

    const FlatPatches& patches_;
    std::vector<PatchGeometry> geometries_;
    std::vector<std::array<Parameters, 2>> sides_;
    std::vector<Boxed> tree_;
};

PatchGeometry NearestPatch::geometry_of(const FlatPatch& flat) {
    Scene plane;
    Patch patch;
    for (std::uint32_t c = 0; c < flat.outline().size(); ++c) {
        plane.vertices.emplace_back(static_cast<float>(flat.corners[c].x), static_cast<float>(flat.corners[c].y), 0.0f);
        patch.vertices[c] = c;
    }
    return {plane, patch};
}

V3f nearest_on_segment(const V3f& a, const V3f& b, const V3f& x) {
    const V3f along = b - a;
    return a + along * std::clamp((x - a).dot(along) / along.length2(), 0.0f, 1.0f);
}

Parameters NearestPatch::nearest_parameters(const PatchGeometry& geometry, const V3f& x) {
    const std::span<const Parameters> corners = corners_of(geometry.is_triangle());
    const std::size_t count = corners.size();
    V3f nearest = x;
    float least2 = std::numeric_limits<float>::max();
    bool is_inside = true;
    for (std::size_t c = 0; c < count; ++c) {
        const V3f a = geometry.point(corners[c]), b = geometry.point(corners[(c + 1) % count]);
        if (geometry.normal().dot((b - a).cross(x - a)) >= 0) continue;
        is_inside = false;
        const V3f candidate = nearest_on_segment(a, b, x);
        if ((candidate - x).length2() >= least2) continue;
        least2 = (candidate - x).length2();
        nearest = candidate;
    }
    return geometry.parameters_of(is_inside ? x : nearest);
}

}  // namespace

std::vector<TexelPlace> places_of(const LightmapChart& chart, int gutter) {
    const NearestPatch nearest(chart);
    const int columns = chart.columns + 2 * gutter, rows = chart.rows + 2 * gutter;
    const auto texel_size = static_cast<float>(std::max(chart.spacing().x, chart.spacing().y));
    std::vector<TexelPlace> places(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    constexpr std::size_t texels_per_task = 1 << 10;
    parallel_for_ranges(places.size(), texels_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto column = static_cast<int>(i % static_cast<std::size_t>(columns)) - gutter;
            const auto row = static_cast<int>(i / static_cast<std::size_t>(columns)) - gutter;
            places[i] = nearest.find(Imath::V2d(column, row) * chart.spacing(), texel_size);
        }
    });
    return places;
}

std::vector<std::size_t> copied_texels(std::span<const TexelPlace> places, std::size_t columns) {
    std::vector<std::size_t> copied(places.size(), no_texel), reached;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].is_near) {
            copied[i] = i;
            reached.push_back(i);
        }
    for (std::size_t next = 0; next < reached.size(); ++next) {
        const std::size_t i = reached[next], column = i % columns;
        const auto fill = [&](std::size_t neighbour) {
            if (copied[neighbour] != no_texel) return;
            copied[neighbour] = copied[i];
            reached.push_back(neighbour);
        };
        if (column > 0) fill(i - 1);
        if (column + 1 < columns) fill(i + 1);
        if (i >= columns) fill(i - columns);
        if (i + columns < places.size()) fill(i + columns);
    }
    return copied;
}

}  // namespace interflect::detail
