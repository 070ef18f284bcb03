#include "interflect/solver/light/textured_elements.h"

#include <algorithm>
#include <utility>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

TexturedElements::TexturedElements(const Scene& scene, std::vector<float> exitance_share)
    : scene_(&scene),
      exitance_share_(std::move(exitance_share)),
      patch_count_(static_cast<std::uint32_t>(scene.patches.size())) {
    const bool is_textured = std::any_of(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
        return scene.materials[patch.material].is_textured();
    });
    if (is_textured) means_ = std::make_unique<TextureMeans>(scene);
}

MeanSurface TexturedElements::mean(PatchIndex patch, const PatchGeometry& geometry, const Cell& cell) const {
    const Patch& p = scene_->patches[patch];
    const Material& material = scene_->materials[p.material];
    MeanSurface surface{material.reflectance * means_->mean(material.reflectance_texture, p, geometry, cell),
                        material.exitance * means_->mean(material.exitance_texture, p, geometry, cell),
                        material.transmittance * means_->mean(material.transmittance_texture, p, geometry, cell)};
    if (!exitance_share_.empty()) surface.exitance *= exitance_share_[patch];
    return surface;
}

void TexturedElements::grow(const ElementForest& forest) {
    if (empty()) return;
    constexpr std::size_t slots_per_task = 64;
    const auto first_slot = static_cast<std::uint32_t>(surfaces_.size() / 4);
    std::vector<ElementIndex> first_children;
    for (ElementIndex e(patch_count_ + 4 * slot_of_block_.size()); e < forest.size(); e += 4) {
        const bool is_textured = scene_->materials[scene_->patches[forest.patch(e)].material].is_textured();
        slot_of_block_.push_back(is_textured ? static_cast<std::uint32_t>(first_slot + first_children.size()) : none);
        if (is_textured) first_children.push_back(e);
    }
    surfaces_.resize(surfaces_.size() + 4 * first_children.size());
    parallel_for_ranges(first_children.size(), slots_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ElementIndex first = first_children[i];
            const PatchIndex patch = forest.patch(first);
            for (std::uint32_t k = 0; k < 4; ++k)
                surfaces_[4 * (first_slot + i) + k] = mean(patch, forest.geometry(patch), forest.cell(first + k));
        }
    });
}

}  // namespace interflect::detail
