#include "interflect/solver/clusters/patch_clusters.h"

#include <ImathMatrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "interflect/base/parallel.h"

namespace interflect::detail {

namespace {

constexpr std::size_t trees = 4;

using Place = std::array<float, 6>;  // position and normal
using Range = std::span<std::uint32_t>;

V3f centre(const PatchGeometry& geometry) { return geometry.point(Cell().centre(geometry.is_triangle())); }

/// Returns the median distance from surfaces to those opposite, which does not depend on their tessellation [m].
float distance_of_surfaces(const ElementForest& forest, const RayCaster& ray_caster) {
    constexpr int rays = 1024;
    double area = 0;
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) area += forest.area(p);
    std::vector<Ray> normals;
    double below = 0;
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) {
        below += forest.area(p);
        const PatchGeometry& geometry = forest.geometry(p);
        const Ray ray{centre(geometry) + geometry.normal() * ray_caster.ray_offset(p), geometry.normal()};
        while (normals.size() < rays && (static_cast<double>(normals.size()) + 0.5) * area < below * rays)
            normals.push_back(ray);
    }
    std::vector<Hit> hits(normals.size());
    ray_caster.trace(normals, hits);
    std::vector<float> distances;
    for (const Hit& hit : hits)
        if (hit.patch != none) distances.push_back(hit.distance);
    if (distances.empty()) return static_cast<float>(std::sqrt(area));
    const auto median = distances.begin() + std::ssize(distances) / 2;
    std::nth_element(distances.begin(), median, distances.end());
    return *median;
}

std::vector<Place> places(const ElementForest& forest, float length, float turn) {
    Imath::M44f rotation;
    rotation.setAxisAngle(V3f(1, 1, 1).normalized(), turn);
    std::vector<Place> places(forest.patch_count());
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p) {
        V3f position, normal;
        rotation.multDirMatrix(centre(forest.geometry(p)) / length, position);
        rotation.multDirMatrix(forest.geometry(p).normal(), normal);
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

PatchClusters::PatchClusters(const ElementForest& forest, std::vector<std::uint32_t> patches, float length, float turn)
    : patch_count_(forest.patch_count()) {
    const std::vector<Place> of_patch = places(forest, length, turn);
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
            divide(range, range.size() < 2 * std::size_t{most_parts + 1} ? 2 : 3, of_patch, ranges);
        nodes_.push_back({static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(ranges.size() - before)});
    }
}

std::vector<PatchClusters> cluster_patches(const ElementForest& forest, const RayCaster& ray_caster) {
    const float length = distance_of_surfaces(forest, ray_caster);
    std::vector<std::uint32_t> patches;
    for (std::uint32_t p = 0; p < forest.patch_count(); ++p)
        if (ray_caster.uncovered_share(p) > 0) patches.push_back(p);
    // A turn of 120 degrees about (1, 1, 1) would exchange the axes.
    std::vector<std::vector<PatchClusters>> made(trees);
    parallel_for_ranges(trees, 1, [&](std::size_t tree, std::size_t) {
        const float turn = static_cast<float>(tree) / trees * 2 * std::numbers::pi_v<float> / 3;
        made[tree].emplace_back(forest, patches, length, turn);
    });
    std::vector<PatchClusters> all;
    all.reserve(trees);
    for (std::vector<PatchClusters>& tree : made) all.push_back(std::move(tree.front()));
    return all;
}

}  // namespace interflect::detail
