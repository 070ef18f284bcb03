#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

/// An end of a link is an element or, from this index on, a cluster of a PatchTree.
inline constexpr std::uint32_t first_cluster = std::uint32_t{1} << 31;
constexpr bool is_cluster(ElementIndex end) { return end >= first_cluster; }

/// Two ends of a link.
struct ElementPair {
    ElementIndex a, b;
};

constexpr bool has_cluster(const ElementPair& pair) { return is_cluster(pair.a) || is_cluster(pair.b); }

struct Sphere {
    V3f centre;
    float radius;
};

/// Flat surface, described by its centre and area.
struct ClusterMember {
    V3f centre;
    V3f area_vector;  ///< Unit normal times area [m^2].
    ElementIndex element;
};

ClusterMember member_of(const ElementForest& forest, ElementIndex element);
/// Returns a sphere that contains the element, around the mean of its corners.
Sphere sphere_around(const ElementForest& forest, ElementIndex element);

/// Binary tree of clusters. A cluster contains at least two patches that are near each other, with any normals.
class PatchTree {
  public:
    struct Cluster {
        std::uint32_t first_member, end_member;
        std::array<ElementIndex, 2> children;  ///< Clusters or patches.
        Sphere sphere;                         ///< Contains the patches; its centre is their area-weighted mean.
        float largest_radius;                  ///< Largest radius of a patch [m].
        float area;                            ///< Total area [m^2].
    };

    PatchTree() = default;
    PatchTree(const ElementForest& forest, const std::vector<PatchIndex>& patches);

    /// Returns the clusters; none for fewer than two patches. The root is the first, and parents precede their
    /// children.
    std::span<const Cluster> clusters() const { return clusters_; }
    const Cluster& cluster(ElementIndex end) const { return clusters_[end - first_cluster]; }
    std::span<const ClusterMember> members(ElementIndex end) const {
        return std::span(members_).subspan(cluster(end).first_member,
                                           cluster(end).end_member - cluster(end).first_member);
    }

    /// Computes a value of each cluster from those of its children: combine(cluster, of_child_0, of_child_1).
    template <class T, class Combine>
    std::vector<T> pulled(const std::vector<T>& of_patch, const Combine& combine) const {
        std::vector<T> of_cluster(clusters_.size());
        const auto value = [&](ElementIndex end) {
            return is_cluster(end) ? of_cluster[end - first_cluster] : of_patch[end];
        };
        for (std::size_t i = clusters_.size(); i-- > 0;)
            of_cluster[i] = combine(clusters_[i], value(clusters_[i].children[0]), value(clusters_[i].children[1]));
        return of_cluster;
    }

  private:
    std::vector<Cluster> clusters_;
    std::vector<ClusterMember> members_;
};

}  // namespace interflect::detail
