#include "interflect/exports/lightmap/texels.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <limits>

#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/search/box_tree.h"

namespace interflect::detail {

namespace {

/// Returns the sides of a texel along the columns and rows of a chart, in the parameters of a patch. A quadrilateral
/// is treated as the parallelogram of its edges at corner 0.
/// @param spacing  Width and height of a texel [m].
std::array<Parameters, 2> texel_sides(const FlatPatch& flat, const Imath::V2d& spacing) {
    const Imath::V2d u = flat.corners[1] - flat.corners[0],
                     v = flat.corners[static_cast<std::size_t>(flat.count) - 1] - flat.corners[0];
    // Solve side = a u + b v by Cramer's rule
    const double determinant = u.cross(v);
    const auto parameters = [&](const Imath::V2d& side) {
        return Parameters{static_cast<float>(side.cross(v) / determinant),
                          static_cast<float>(u.cross(side) / determinant)};
    };
    return {parameters({spacing.x, 0}), parameters({0, spacing.y})};
}

/// Returns a patch of a chart as a patch in the plane z = 0 of space.
PatchGeometry geometry_in_chart(const FlatPatch& flat) {
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

/// Returns the parameters of the point of a convex patch that is nearest to x.
/// @param x  Point in the plane of the patch.
Parameters nearest_parameters(const PatchGeometry& geometry, const V3f& x) {
    const std::span<const Parameters> corners = corners_of(geometry.is_triangle());
    V3f nearest = x;
    float least_distance2 = std::numeric_limits<float>::max();
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const V3f a = geometry.point(corners[c]), b = geometry.point(corners[(c + 1) % corners.size()]);
        const bool is_on_inner_side = geometry.normal().dot((b - a).cross(x - a)) >= 0;
        if (is_on_inner_side) continue;
        const V3f candidate = nearest_on_segment(a, b, x);
        const float distance2 = (candidate - x).length2();
        if (distance2 >= least_distance2) continue;
        least_distance2 = distance2;
        nearest = candidate;
    }
    return geometry.parameters_of(nearest);
}

/// Finds the places of texels on the patches of a chart.
class PlaceFinder {
  public:
    /// Refers to its argument.
    explicit PlaceFinder(const LightmapChart& chart) : patches_(chart.patches) {
        for (std::uint32_t i = 0; i < patches_.size(); ++i) {
            const PatchGeometry& geometry = geometries_.emplace_back(geometry_in_chart(patches_[i]));
            sides_.push_back(texel_sides(patches_[i], chart.spacing()));
            Imath::Box3f box;
            for (const Parameters& corner : corners_of(geometry.is_triangle())) box.extendBy(geometry.point(corner));
            tree_.push_back({box, i});
        }
        arrange_box_tree(tree_);
    }

    /// Returns the place of a texel. If several patches are equally near, it is on the one with the lowest index.
    /// @param centre      Centre of the texel in the chart [m].
    /// @param texel_size  Larger side of a texel [m].
    TexelPlace find(const Imath::V2d& centre, float texel_size) const {
        const V3f x(static_cast<float>(centre.x), static_cast<float>(centre.y), 0);
        TexelPlace place;
        float least_distance2 = std::numeric_limits<float>::max();
        const auto may_be_nearest = [&](const Imath::Box3f& box) {
            return (Imath::closestPointInBox(x, box) - x).length2() <= least_distance2;
        };
        visit_box_tree(std::span<const Boxed>(tree_), may_be_nearest, [&](std::uint32_t i) {
            const PatchIndex patch = patches_[i].patch;
            const Parameters at = nearest_parameters(geometries_[i], x);
            const float distance2 = (geometries_[i].point(at) - x).length2();
            const bool precedes = place.patch == none || patch < place.patch;
            if (distance2 < least_distance2 || (distance2 == least_distance2 && precedes)) {
                least_distance2 = distance2;
                place.patch = patch;
                place.at = at;
                place.sides = sides_[i];
            }
        });
        constexpr float rounding = 1e-3f;  // tolerance of distances [texels]
        place.is_inside = least_distance2 <= rounding * rounding * texel_size * texel_size;
        // Bilinear interpolation reads no texel at a distance of 1 texel, even if rounding makes it seem nearer
        constexpr float read_distance = 1 - rounding;  // [texels]
        place.is_evaluated = least_distance2 < read_distance * read_distance * texel_size * texel_size;
        return place;
    }

  private:
    const FlatPatches& patches_;
    std::vector<PatchGeometry> geometries_;         // one entry per patch, like sides_
    std::vector<std::array<Parameters, 2>> sides_;  // results of texel_sides()
    std::vector<Boxed> tree_;
};

}  // namespace

std::vector<TexelPlace> places_of(const LightmapChart& chart, int gutter) {
    const PlaceFinder finder(chart);
    const int columns = chart.columns + 2 * gutter, rows = chart.rows + 2 * gutter;
    const auto texel_size = static_cast<float>(std::max(chart.spacing().x, chart.spacing().y));
    std::vector<TexelPlace> places(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    constexpr std::size_t texels_per_task = 1 << 10;
    parallel_for_ranges(places.size(), texels_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto column = static_cast<int>(i % static_cast<std::size_t>(columns)) - gutter;
            const auto row = static_cast<int>(i / static_cast<std::size_t>(columns)) - gutter;
            places[i] = finder.find(Imath::V2d(column, row) * chart.spacing(), texel_size);
        }
    });
    return places;
}

std::vector<std::size_t> copied_texels(std::span<const TexelPlace> places, std::size_t columns) {
    std::vector<std::size_t> copied(places.size(), no_texel), reached;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].is_evaluated) {
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
