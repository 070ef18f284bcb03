#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/elements/texture_means.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Mean of the material over an element.
struct MeanSurface {
    Rgb reflectance{0, 0, 0};
    Rgb exitance{0, 0, 0};  ///< [lm/m^2 or W/m^2]
    Rgb transmittance{0, 0, 0};
};

/// Mean materials of the elements of textured patches.
class TexturedElements {
  public:
    /// @param exitance_share  Factor of the exitance of each patch; empty: 1.
    explicit TexturedElements(const Scene& scene, std::vector<float> exitance_share = {});

    bool empty() const { return !means_; }

    MeanSurface of_patch(PatchIndex patch, const PatchGeometry& geometry) const { return mean(patch, geometry, {}); }

    /// Returns the means of an element below a patch; null if it has no texture, or before grow().
    const MeanSurface* find(ElementIndex element) const {
        const std::uint32_t block = (element - patch_count_) / 4;
        if (block >= slot_of_block_.size() || slot_of_block_[block] == none) return nullptr;
        return &surfaces_[4 * std::size_t{slot_of_block_[block]} + (element - patch_count_) % 4];
    }

    void grow(const ElementForest& forest);

  private:
    MeanSurface mean(PatchIndex patch, const PatchGeometry& geometry, const Cell& cell) const;

    const Scene* scene_;
    std::vector<float> exitance_share_;
    std::unique_ptr<TextureMeans> means_;
    std::uint32_t patch_count_;
    std::vector<std::uint32_t> slot_of_block_;  // slot of each block of four siblings; none without texture
    std::vector<MeanSurface> surfaces_;         // four for each slot
};

}  // namespace interflect::detail
