#include "interflect/solver/clusters/patch_clusters.h"

#include <ImathMatrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "interflect/base/parallel.h"
#include "interflect/geometry/split.h"

namespace interflect::detail {

namespace {

constexpr std::size_t trees = 4;

/// Position in units of the typical side of a surface, and normal: at this distance, irradiance changes about as much
/// as from one direction to the opposite.
using Place = std::array<float, 6>;
using Range = std::span<std::uint32_t>;

std::vector<Place> places(const ElementForest& forest, float turn) {
    std::vector<float> areas(forest.patch_count());
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) areas[p] = forest.area(p);
    const auto side = static_cast<float>(std::sqrt(median_area(std::move(areas))));
    Imath::M44f rotation;
    rotation.setAxisAngle(V3f(1, 1, 1).normalized(), turn);
    std::vector<Place> places(forest.patch_count());
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) {
        const PatchGeometry& geometry = forest.geometry(p);
        V3f position, normal;
        rotation.multDirMatrix(geometry.point(Cell().centre(geometry.is_triangle())) / side, position);
        rotation.multDirMatrix(geometry.normal(), normal);
        places[p] = {position.x, position.y, position.z, normal.x, normal.y, normal.z};
    }
    return places;
}

/// Moves the patches that are below the median along the widest axis to the front.
void halve(Range patches, const std::vector<Place>& places) {
    Place low, high;
    low.fill(std::numeric_limits<float>::infinity()), high.fill(-std::numeric_limits<float>::infinity());
    for (const std::uint32_t p : patches)
        for (std::size_t i = 0; i < low.size(); ++i)
            low[i] = std::min(low[i], places[p][i]), high[i] = std::max(high[i], places[p][i]);
    std::size_t axis = 0;
    for (std::size_t i = 1; i < low.size(); ++i)
        if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
    std::nth_element(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(patches.size() / 2), patches.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return places[a][axis] != places[b][axis] ? places[a][axis] < places[b][axis] : a < b;
                     });
}

void divide(Range patches, int halvings, const std::vector<Place>& places, std::vector<Range>& parts) {
    if (halvings == 0) return parts.push_back(patches);
    halve(patches, places);
    divide(patches.first(patches.size() / 2), halvings - 1, places, parts);
    divide(patches.subspan(patches.size() / 2), halvings - 1, places, parts);
}

}  // namespace

PatchClusters::PatchClusters(const ElementForest& forest, float turn) : patch_count_(forest.patch_count()) {
    const std::vector<Place> of_patch = places(forest, turn);
    std::vector<std::uint32_t> patches(patch_count_);
    std::iota(patches.begin(), patches.end(), 0u);
    std::vector<Range> ranges{patches};  // of the nodes
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const Range range = ranges[i];
        if (range.size() == 1) {
            nodes_.push_back({none, range.front()});
            continue;
        }
        const std::size_t before = ranges.size();
        if (range.size() <= most_parts)
            for (std::size_t k = 0; k < range.size(); ++k) ranges.push_back(range.subspan(k, 1));
        else
            divide(range, range.size() < 2 * (most_parts + 1) ? 2 : 3, of_patch, ranges);
        nodes_.push_back({static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(ranges.size() - before)});
    }
}

std::vector<PatchClusters> cluster_patches(const ElementForest& forest) {
    // A turn of 120 degrees about (1, 1, 1) would exchange the axes.
    std::vector<std::vector<PatchClusters>> made(trees);
    parallel_for_ranges(trees, 1, [&](std::size_t tree, std::size_t) {
        const float turn = static_cast<float>(tree) / trees * 2 * std::numbers::pi_v<float> / 3;
        made[tree].emplace_back(forest, turn);
    });
    std::vector<PatchClusters> all;
    for (std::vector<PatchClusters>& tree : made) all.push_back(std::move(tree.front()));
    return all;
}

}  // namespace interflect::detail
