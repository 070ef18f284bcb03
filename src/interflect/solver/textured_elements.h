#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/elements/texture_means.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// What a surface does with light on the average over a patch or an element.
struct MeanSurface {
    Rgb reflectance{0, 0, 0};
    Rgb exitance{0, 0, 0};  ///< [lm/m^2 or W/m^2]
    Rgb transmittance{0, 0, 0};
};

/// The mean surfaces of the elements of textured patches; 36 bytes for each of these elements, and one for any. Empty
/// where no patch is textured.
class TexturedElements {
  public:
    /// @param scene           Without faults; must outlive this.
    /// @param exitance_share  By which each patch's exitance is reduced; empty where none is.
    explicit TexturedElements(const Scene& scene, std::vector<float> exitance_share = {});

    bool empty() const { return !means_; }

    /// Of a textured patch.
    MeanSurface of_patch(std::uint32_t patch, const PatchGeometry& geometry) const { return mean(patch, geometry, {}); }

    /// Of an element that is no patch; null where its patch is not textured, and where grow() does not know it yet.
    const MeanSurface* find(std::uint32_t element) const {
        const std::uint32_t block = (element - patch_count_) / 4;
        if (block >= slot_of_block_.size() || slot_of_block_[block] == none) return nullptr;
        return &surfaces_[4 * std::size_t{slot_of_block_[block]} + (element - patch_count_) % 4];
    }

    /// Finds the means of the elements made since the last call.
    void grow(const ElementForest& forest);

  private:
    MeanSurface mean(std::uint32_t patch, const PatchGeometry& geometry, const Cell& cell) const;

    const Scene* scene_;
    std::vector<float> exitance_share_;
    std::unique_ptr<TextureMeans> means_;
    std::uint32_t patch_count_;
    std::vector<std::uint32_t> slot_of_block_;  // of every four siblings; none where their patch is not textured
    std::vector<MeanSurface> surfaces_;         // four a slot
};

}  // namespace interflect::inline detail
