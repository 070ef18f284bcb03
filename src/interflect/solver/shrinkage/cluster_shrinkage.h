#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/solver/clusters/patch_clusters.h"
#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Shrinks differences between the parts of each cluster that consist mostly of noise (docs/method/method.md,
/// Clusters).
class ClusterShrinkage {
  public:
    /// Arguments must outlive this.
    /// @param irradiance  All light or a part of it, one value per patch; values of elements may follow.
    ClusterShrinkage(const LightState& light, const PatchClusters& clusters, std::span<const Rgb> irradiance);

    struct Errors {
        float noise = 0, bias = 0;
    };
    /// Computes the errors of the shrunk means of patches, as squared luminance.
    /// @param shown  Returns the share of the variance of a node, given by its index, that pictures show.
    template <class Shown>
    void measure_errors(std::span<Errors> of_patches, const Shown& shown) const;

    /// Returns the shrunk means of the patches.
    /// @param camera_rays  ViewImportance::rays() of the views.
    std::vector<Rgb> means(std::int64_t camera_rays) const;

  private:
    struct Part {
        float share = 1;     // share of the area of its cluster
        float kept = 1;      // weight of its own mean in the shrunk mean; the cluster's mean has weight 1 - kept
        float variance = 0;  // variance of its own mean, as squared luminance
        float signal = 0;    // variance of the true means of the parts of its cluster
    };
    using Means = std::array<float, PatchClusters::most_parts>;

    void measure_parts();
    std::vector<Rgb> reduce() const;
    static Means reduce_parts(std::span<const Part> parts, const Means& own, float mean, float to_channel);
    void keep_means_of_pictures(std::int64_t camera_rays, std::vector<Rgb>& means) const;

    const LightState* light_;
    const PatchClusters* clusters_;
    std::span<const Rgb> irradiance_;
    std::vector<Part> parts_;  // one for each node of the tree
};

template <class Shown>
void ClusterShrinkage::measure_errors(std::span<Errors> of_patches, const Shown& shown) const {
    std::vector<Errors> errors(parts_.size());
    errors[0] = {shown(0) * parts_[0].variance, 0};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const auto [first, count, patch] = clusters_->nodes()[i];
        if (patch != none) {
            of_patches[patch] = errors[i];
            continue;
        }
        for (std::uint32_t k = first; k < first + count; ++k) {
            const Part& part = parts_[k];
            const float own = part.kept * part.kept, of_cluster = (1 - part.kept) * (1 - part.kept);
            errors[k] = {own * shown(k) * part.variance + of_cluster * errors[i].noise,
                         of_cluster * (shown(k) * part.signal + errors[i].bias)};
        }
    }
}

}  // namespace interflect::detail
