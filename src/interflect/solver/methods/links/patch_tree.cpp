#include "interflect/solver/methods/links/patch_tree.h"

#include <ImathBox.h>

#include <algorithm>

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Moves the members below the median along the longest side of their bounding box to the front.
void halve(std::span<ClusterMember> members) {
    Imath::Box3f box;
    for (const ClusterMember& member : members) box.extendBy(member.centre);
    const auto axis = static_cast<int>(box.majorAxis());
    std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2), members.end(),
                     [axis](const ClusterMember& x, const ClusterMember& y) {
                         return x.centre[axis] != y.centre[axis] ? x.centre[axis] < y.centre[axis]
                                                                 : x.element < y.element;
                     });
}

PatchTree::Cluster cluster_of(const ElementForest& forest, std::span<const ClusterMember> members) {
    PatchTree::Cluster cluster{};
    V3d sum(0, 0, 0);
    double area = 0;
    for (const ClusterMember& member : members) {
        area += forest.area(member.element);
        sum += V3d(member.centre) * static_cast<double>(forest.area(member.element));
    }
    cluster.area = static_cast<float>(area);
    cluster.sphere.centre = V3f(sum / area);
    for (const ClusterMember& member : members) {
        const float radius = sphere_around(forest, member.element).radius;
        cluster.largest_radius = std::max(cluster.largest_radius, radius);
        cluster.sphere.radius =
            std::max(cluster.sphere.radius, (member.centre - cluster.sphere.centre).length() + radius);
    }
    return cluster;
}

}  // namespace

ClusterMember member_of(const ElementForest& forest, ElementIndex element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    const V3f centre = geometry.point(forest.cell(element).centre(geometry.is_triangle()));
    return {centre, geometry.normal() * forest.area(element), element};
}

Sphere sphere_around(const ElementForest& forest, ElementIndex element) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(element));
    const Cell cell = forest.cell(element);
    Sphere sphere{geometry.point(cell.centre(geometry.is_triangle())), 0};
    const auto include = [&](float s, float t) {
        sphere.radius = std::max(sphere.radius, (geometry.point(cell.at(s, t)) - sphere.centre).length());
    };
    include(0, 0);
    include(1, 0);
    include(0, 1);
    if (!geometry.is_triangle()) include(1, 1);
    return sphere;
}

PatchTree::PatchTree(const ElementForest& forest, const std::vector<PatchIndex>& patches) {
    for (const PatchIndex patch : patches) members_.push_back(member_of(forest, patch));
    if (members_.size() < 2) return;
    std::vector<std::span<ClusterMember>> ranges{members_};  // members of each cluster
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const std::span<ClusterMember> range = ranges[i];
        halve(range);
        Cluster cluster = cluster_of(forest, range);
        cluster.first_member = static_cast<std::uint32_t>(range.data() - members_.data());
        cluster.end_member = cluster.first_member + static_cast<std::uint32_t>(range.size());
        const std::array halves{range.first(range.size() / 2), range.subspan(range.size() / 2)};
        for (std::size_t k = 0; k < 2; ++k) {
            cluster.children[k] =
                halves[k].size() == 1 ? halves[k].front().element : ElementIndex(first_cluster + ranges.size());
            if (halves[k].size() > 1) ranges.push_back(halves[k]);
        }
        clusters_.push_back(cluster);
    }
}

}  // namespace interflect::detail
