#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"

namespace interflect::detail {

/// Tree of clusters. The lowest clusters contain patches that are near each other, with similar normals and openness;
/// the root contains the whole scene.
class PatchClusters {
  public:
    /// Maximum number of patches in a cluster that is not divided further.
    static constexpr std::uint32_t most_parts = 31;

    struct Node {
        std::uint32_t first_child;  ///< none for a patch.
        std::uint32_t child_count;  ///< 0 for a patch.
        PatchIndex patch;           ///< none for a cluster.

        bool is_patch() const { return patch != no_patch; }
    };

    /// @param patches    Patches to be divided into clusters.
    /// @param distances  Distance from each patch to the surface opposite it [m]; faces in gaps receive little light.
    /// @param length     Distance over which irradiance changes as much as between opposite normals [m].
    /// @param turn       Angle by which the scene is turned before it is divided [rad].
    PatchClusters(const ElementForest& forest, std::span<const PatchIndex> patches, std::span<const float> distances,
                  float length, float turn);

    std::uint32_t patch_count() const { return patch_count_; }
    /// Returns the nodes. Parents precede their children, and the children of a node are adjacent.
    std::span<const Node> nodes() const { return nodes_; }

    /// Returns the sum over the patches of each node. Calls of_patch(patch) on all threads.
    template <class T, class OfPatch>
    std::vector<T> sums(const OfPatch& of_patch) const {
        std::vector<T> sums(nodes_.size(), T(0));
        parallel_for_indices(nodes_.size(), [&](std::size_t i) {
            if (nodes_[i].is_patch()) sums[i] = T(of_patch(nodes_[i].patch));
        });
        for (std::size_t i = nodes_.size(); i-- > 0;)
            for (std::uint32_t k = 0; k < nodes_[i].child_count; ++k) sums[i] += sums[nodes_[i].first_child + k];
        return sums;
    }

  private:
    std::uint32_t patch_count_;
    std::vector<Node> nodes_;
};

/// Returns several trees with different boundaries between clusters; their results are averaged. Patches that others
/// cover completely receive no light and are omitted.
std::vector<PatchClusters> cluster_patches(const ElementForest& forest, const RayCaster& ray_caster);

}  // namespace interflect::detail
