#include "interflect/solver/clusters/patch_clusters.h"

#include <ImathMatrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

/// Number of trees whose results are averaged.
constexpr std::size_t trees = 4;

using Features = std::array<float, 7>;  // position, normal, openness (0 in narrow gaps, 1 without an opposite surface)
struct PatchFeatures {
    Features features;
    PatchIndex patch;
};
using Range = std::span<PatchFeatures>;

V3f centre(const PatchGeometry& geometry) { return geometry.point(Cell().centre(geometry.is_triangle())); }

/// Returns the distance from the centre of each patch to the surface opposite it, along the normal [m].
std::vector<float> distances(const ElementForest& forest, const RayCaster& ray_caster) {
    constexpr std::size_t patches_per_task = 1 << 12;
    std::vector<float> distances(forest.patch_count(), std::numeric_limits<float>::infinity());
    parallel_for_ranges(forest.patch_count(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<Ray> normals;
        for (PatchIndex p(begin); p < end; ++p) {
            const V3f normal = forest.geometry(p).normal();
            normals.push_back({centre(forest.geometry(p)) + normal * ray_caster.ray_offset(p), normal});
        }
        std::vector<Hit> hits(normals.size());
        ray_caster.trace(normals, hits);
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (hits[i].patch != none) distances[begin + i] = hits[i].distance;
    });
    return distances;
}

/// Returns half of the median distance between opposite surfaces [m]. The median is weighted by area and distance,
/// because little light enters narrow gaps.
float distance_of_change(const ElementForest& forest, std::span<const float> distances) {
    std::vector<PatchIndex> bounded;
    double area = 0, weights = 0;
    for (PatchIndex p{0}; p < forest.patch_count(); ++p) {
        area += forest.area(p);
        if (!std::isfinite(distances[p])) continue;
        bounded.push_back(p);
        weights += static_cast<double>(forest.area(p)) * distances[p];
    }
    std::ranges::sort(bounded, {}, [&](PatchIndex p) { return distances[p]; });
    double below = 0;
    for (const PatchIndex p : bounded)
        if ((below += static_cast<double>(forest.area(p)) * distances[p]) >= weights / 2) return distances[p] / 2;
    return static_cast<float>(std::sqrt(area)) / 2;
}

/// Returns the features of the patches: positions relative to `length` [m], rotated with the normals by `turn` [rad].
std::vector<PatchFeatures> features_of(const ElementForest& forest, std::span<const PatchIndex> patches,
                                       std::span<const float> distances, float length, float turn) {
    constexpr float weight_of_openness = 2;  // equal to the distance between opposite unit normals
    Imath::M44f rotation;
    rotation.setAxisAngle(V3f(1, 1, 1).normalized(), turn);
    std::vector<PatchFeatures> result;
    result.reserve(patches.size());
    for (const PatchIndex p : patches) {
        V3f position, normal;
        rotation.multDirMatrix(centre(forest.geometry(p)) / length, position);
        rotation.multDirMatrix(forest.geometry(p).normal(), normal);
        const float openness = std::isfinite(distances[p]) ? distances[p] / (distances[p] + length) : 1;
        result.push_back(
            {{position.x, position.y, position.z, normal.x, normal.y, normal.z, weight_of_openness * openness}, p});
    }
    return result;
}

/// Moves the patches that are below the median along the widest axis to the front.
void halve(Range patches) {
    Features low = patches.front().features, high = low;
    for (const PatchFeatures& p : patches)
        for (std::size_t i = 0; i < low.size(); ++i) {
            low[i] = std::min(low[i], p.features[i]);
            high[i] = std::max(high[i], p.features[i]);
        }
    std::size_t axis = 0;
    for (std::size_t i = 1; i < low.size(); ++i)
        if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
    std::nth_element(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(patches.size() / 2), patches.end(),
                     [&](const PatchFeatures& a, const PatchFeatures& b) {
                         return a.features[axis] != b.features[axis] ? a.features[axis] < b.features[axis]
                                                                     : a.patch < b.patch;
                     });
}

void divide(Range patches, int halvings, std::vector<Range>& parts) {
    if (halvings == 0) return parts.push_back(patches);
    halve(patches);
    divide(patches.first(patches.size() / 2), halvings - 1, parts);
    divide(patches.subspan(patches.size() / 2), halvings - 1, parts);
}

}  // namespace

PatchClusters::PatchClusters(const ElementForest& forest, std::span<const PatchIndex> patches,
                             std::span<const float> distances, float length, float turn)
    : patch_count_(forest.patch_count()) {
    std::vector<PatchFeatures> features = features_of(forest, patches, distances, length, turn);
    std::vector<Range> ranges{features};  // patches of each node
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const Range range = ranges[i];
        if (range.size() == 1) {
            nodes_.push_back({none, 0, range.front().patch});
            continue;
        }
        const std::size_t before = ranges.size();
        if (range.size() <= most_parts)
            for (std::size_t k = 0; k < range.size(); ++k) ranges.push_back(range.subspan(k, 1));
        else  // into 4 or 8 children
            divide(range, range.size() < 2 * std::size_t{most_parts + 1} ? 2 : 3, ranges);
        nodes_.push_back(
            {static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(ranges.size() - before), no_patch});
    }
}

std::vector<PatchClusters> cluster_patches(const ElementForest& forest, const RayCaster& ray_caster) {
    const std::vector<float> to_opposite = distances(forest, ray_caster);
    const float length = distance_of_change(forest, to_opposite);
    std::vector<PatchIndex> patches;
    for (PatchIndex p{0}; p < forest.patch_count(); ++p)
        if (ray_caster.uncovered_share(p) > 0) patches.push_back(p);
    // The trees are turned by equal steps below 120 degrees about (1, 1, 1), a turn that would only exchange the axes.
    std::vector<std::vector<PatchClusters>> made(trees);
    parallel_for_ranges(trees, 1, [&](std::size_t tree, std::size_t) {
        const float turn = static_cast<float>(tree) / trees * 2 * std::numbers::pi_v<float> / 3;
        made[tree].emplace_back(forest, patches, to_opposite, length, turn);
    });
    std::vector<PatchClusters> all;
    all.reserve(trees);
    for (std::vector<PatchClusters>& tree : made) all.push_back(std::move(tree.front()));
    return all;
}

}  // namespace interflect::detail
