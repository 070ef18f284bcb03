#include "interflect/solver/methods/links/patch_tree.h"

#include <ImathBox.h>

#include <algorithm>

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Moves the facets below the median along the longest side of their bounding box to the front.
void halve(std::span<Facet> facets) {
    Imath::Box3f box;
    for (const Facet& facet : facets) box.extendBy(facet.centre);
    const auto axis = static_cast<int>(box.majorAxis());
    std::nth_element(facets.begin(), facets.begin() + static_cast<std::ptrdiff_t>(facets.size() / 2), facets.end(),
                     [axis](const Facet& x, const Facet& y) {
                         return x.centre[axis] != y.centre[axis] ? x.centre[axis] < y.centre[axis]
                                                                 : x.element < y.element;
                     });
}

PatchTree::Cluster cluster_of(const ElementForest& forest, std::span<const Facet> facets) {
    PatchTree::Cluster cluster{};
    V3d sum(0, 0, 0);
    double area = 0;
    for (const Facet& facet : facets) {
        area += forest.area(facet.element);
        sum += V3d(facet.centre) * static_cast<double>(forest.area(facet.element));
    }
    cluster.area = static_cast<float>(area);
    cluster.sphere.centre = V3f(sum / area);
    for (const Facet& facet : facets) {
        const float radius = sphere_around(forest, facet.element).radius;
        cluster.largest_radius = std::max(cluster.largest_radius, radius);
        cluster.sphere.radius =
            std::max(cluster.sphere.radius, (facet.centre - cluster.sphere.centre).length() + radius);
    }
    return cluster;
}

}  // namespace

Facet facet_of(const ElementForest& forest, std::uint32_t element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    const V3f centre = geometry.point(forest.cell(element).centre(geometry.is_triangle()));
    return {centre, geometry.normal() * forest.area(element), element};
}

Sphere sphere_around(const ElementForest& forest, std::uint32_t element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    const Cell cell = forest.cell(element);
    Sphere sphere{geometry.point(cell.centre(geometry.is_triangle())), 0};
    const auto include = [&](float s, float t) {
        sphere.radius = std::max(sphere.radius, (geometry.point(cell.at(s, t)) - sphere.centre).length());
    };
    include(0, 0), include(1, 0), include(0, 1);
    if (!geometry.is_triangle()) include(1, 1);
    return sphere;
}

PatchTree::PatchTree(const ElementForest& forest, std::vector<std::uint32_t> patches) {
    for (const std::uint32_t patch : patches) facets_.push_back(facet_of(forest, patch));
    if (facets_.size() < 2) return;
    std::vector<std::span<Facet>> ranges{facets_};  // of the clusters
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const std::span<Facet> range = ranges[i];
        halve(range);
        Cluster cluster = cluster_of(forest, range);
        cluster.first_facet = static_cast<std::uint32_t>(range.data() - facets_.data());
        cluster.end_facet = cluster.first_facet + static_cast<std::uint32_t>(range.size());
        const std::array halves{range.first(range.size() / 2), range.subspan(range.size() / 2)};
        for (std::size_t k = 0; k < 2; ++k) {
            cluster.children[k] = halves[k].size() == 1 ? halves[k].front().element
                                                        : first_cluster + static_cast<std::uint32_t>(ranges.size());
            if (halves[k].size() > 1) ranges.push_back(halves[k]);
        }
        clusters_.push_back(cluster);
    }
}

}  // namespace interflect::detail
