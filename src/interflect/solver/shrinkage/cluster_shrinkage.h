#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/solver/clusters/patch_clusters.h"
#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Reduces the differences between the parts of each cluster that are mostly noise (docs/method/method.md, Clusters).
class ClusterShrinkage {
  public:
    /// @param light, clusters, irradiance  Must outlive this. The irradiance is all light or a part of it, by patch;
    /// elements may follow.
    ClusterShrinkage(const LightState& light, const PatchClusters& clusters, std::span<const Rgb> irradiance);

    struct Errors {
        float noise = 0, bias = 0;
    };
    /// Sets the errors of the reduced means of patches, as squared luminance.
    /// @param shown  Returns the share of variance that pictures show of a node, by its index.
    template <class Shown>
    void measure_errors(std::span<Errors> of_patches, const Shown& shown) const;

    /// Returns the reduced means of the patches.
    /// @param camera_rays  ViewImportance::rays() of the views.
    std::vector<Rgb> means(std::int64_t camera_rays) const;

  private:
    struct Part {
        float share = 1;     // of its cluster's area
        float kept = 1;      // share of its own mean; the rest is its cluster's
        float variance = 0;  // of its own mean, as squared luminance
        float signal = 0;    // variance of the true means in its cluster
    };
    using Means = std::array<float, PatchClusters::most_parts>;

    void measure_parts();
    std::vector<Rgb> reduce() const;
    static Means reduce_parts(std::span<const Part> parts, const Means& own, float mean, float to_channel);
    void keep_means_of_pictures(std::int64_t camera_rays, std::vector<Rgb>& means) const;

    const LightState* light_;
    const PatchClusters* clusters_;
    std::span<const Rgb> irradiance_;
    std::vector<Part> parts_;  // by node
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
