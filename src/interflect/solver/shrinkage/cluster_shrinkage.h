#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/solver/clusters/patch_clusters.h"
#include "interflect/solver/shrinkage/sibling_variation.h"
#include "interflect/solver/state/solver_state.h"

namespace interflect::detail {

struct ClusterPart {
    float share = 1;            ///< Of its cluster's area.
    float kept = 1, noise = 1;  ///< As in Shrinkage.
};

/// Shrinks the differences between the parts of each cluster, as those between siblings (docs/method.md, Clusters).
class ClusterShrinkage {
  public:
    /// @param clusters  Must outlive this.
    ClusterShrinkage(const SolverState& state, const PatchClusters& clusters);

    /// Adds the errors of the reduced means of patches, as squared luminance.
    /// @param weight  Factor of the errors.
    /// @param shown  Returns the share of variance that pictures show of a node, by its index.
    template <class Shown>
    void add_errors(std::span<float> noise, std::span<float> bias, float weight, const Shown& shown) const;

    /// Returns the reduced means of the patches, of all light or of a part of it.
    /// @param irradiance  By patch; elements may follow.
    std::vector<Rgb> reduce(std::span<const Rgb> irradiance) const;

  private:
    std::vector<RgbD> means(std::span<const Rgb> irradiance) const;
    /// From the scene to the patches. @param limit_of  Returns the factor of a cluster's differences from its index,
    /// its reduced mean and the reduced differences of its parts.
    template <class LimitOf>
    std::vector<Rgb> reduced(std::span<const Rgb> irradiance, const LimitOf& limit_of) const;

    /// Clusters preserve the means of areas. Pictures show parts of them, which may be brighter than what is hidden.
    void keep_means_of_pictures(const SolverState& state, std::span<const Rgb> reduced);

    const PatchClusters* clusters_;
    std::vector<ClusterPart> parts_;  // by node
    std::vector<AddedError> added_;   // by node, of its parts
    std::vector<Rgb> limit_;          // by node: keeps irradiance non-negative
    std::vector<Rgb> restored_;       // by patch: keeps the means of what pictures show
    float noise_of_scene_ = 0;
};

template <class Shown>
void ClusterShrinkage::add_errors(std::span<float> noise, std::span<float> bias, float weight,
                                  const Shown& shown) const {
    std::vector<AddedError> error(parts_.size());
    error[0] = {shown(0) * noise_of_scene_, 0};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const PatchClusters::Node& node = clusters_->nodes()[i];
        if (node.is_patch()) {
            noise[node.count] += weight * error[i].noise, bias[node.count] += weight * error[i].bias;
            continue;
        }
        for (std::uint32_t part = node.first_child; part < node.first_child + node.count; ++part) {
            const float of_part = shown(part);
            error[part] = {parts_[part].noise * (error[i].noise + of_part * added_[i].noise),
                           error[i].bias + of_part * added_[i].bias};
        }
    }
}

}  // namespace interflect::detail
