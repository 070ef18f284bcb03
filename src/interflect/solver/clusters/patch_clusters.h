#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"

namespace interflect::detail {

/// Trees of clusters: groups of patches that are near each other and face alike, groups of groups, up to the roots. The
/// patches that the views show have a tree of their own.
class PatchClusters {
  public:
    /// Groups of 32 are divided into four of eight.
    static constexpr std::uint32_t most_parts = 31;

    struct Node {
        std::uint32_t first_child;  ///< `none`: the node is a patch.
        std::uint32_t count;        ///< Children; of a patch, its index.

        bool is_patch() const { return first_child == none; }
    };

    /// @param shown  Patches that the views show. @param others  All others. Either may be empty.
    /// @param length  Distance over which irradiance changes about as much as from one direction to the opposite [m].
    /// @param turn  Angle by which the scene is turned before it is divided [radians].
    PatchClusters(const ElementForest& forest, std::vector<std::uint32_t> shown, std::vector<std::uint32_t> others,
                  float length, float turn);

    std::uint32_t patch_count() const { return patch_count_; }
    /// The first nodes are the roots.
    std::uint32_t root_count() const { return root_count_; }
    bool is_shown(std::uint32_t patch) const { return is_shown_[patch] != 0; }
    /// Parents first; children of a node are adjacent.
    std::span<const Node> nodes() const { return nodes_; }

    /// Returns the sum over the patches of each node.
    template <class T, class OfPatch>
    std::vector<T> sums(const OfPatch& of_patch) const {
        std::vector<T> sums(nodes_.size(), T(0));
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            const Node& node = nodes_[i];
            if (node.is_patch())
                sums[i] = T(of_patch(node.count));
            else
                for (std::uint32_t k = 0; k < node.count; ++k) sums[i] += sums[node.first_child + k];
        }
        return sums;
    }

  private:
    std::uint32_t patch_count_, root_count_;
    std::vector<std::uint8_t> is_shown_;  // by patch
    std::vector<Node> nodes_;
};

/// Returns trees with different boundaries between clusters, to be averaged. They lack patches that are wholly covered
/// by others, and receive no light.
/// @param view_importance  By element [1/m^2]; empty without views.
std::vector<PatchClusters> cluster_patches(const ElementForest& forest, const RayCaster& ray_caster,
                                           std::span<const float> view_importance);

}  // namespace interflect::detail
