#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/elements/texture_means.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct MeanSurface {
    Rgb reflectance{0, 0, 0};
    Rgb exitance{0, 0, 0};  ///< [lm/m^2 or W/m^2]
    Rgb transmittance{0, 0, 0};
};

class TexturedElements {
  public:
    /// @param exitance_share  By patch; empty: 1.
    explicit TexturedElements(const Scene& scene, std::vector<float> exitance_share = {});

    bool empty() const { return !means_; }

    MeanSurface of_patch(PatchIndex patch, const PatchGeometry& geometry) const { return mean(patch, geometry, {}); }

    /// Null if not textured, or before grow(). Not for roots.
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
    std::vector<std::uint32_t> slot_of_block_;  // one per block of siblings, if textured
    std::vector<MeanSurface> surfaces_;         // four per slot
};

}  // namespace interflect::detail
