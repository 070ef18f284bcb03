#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/numbers/ranked_bits.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solver/light/textured_elements.h"

namespace interflect::detail {

/// Reflectance, exitance and transmittance of each patch and, with textures, of each element. Refers to the scene. The
/// exitance of partly covered emitters is multiplied by their uncovered share (RayCaster).
class Materials {
  public:
    /// Uses the full exitance of covered emitters.
    explicit Materials(const Scene& scene) : Materials(scene, std::vector<float>()) {}
    Materials(const Scene& scene, const RayCaster& ray_caster);

    const Scene& scene() const { return *scene_; }
    bool has_panes() const { return has_panes_; }
    const Rgb& reflectance(PatchIndex patch) const { return material(patch).reflectance; }
    const Rgb& exitance(PatchIndex patch) const { return material(patch).exitance; }  ///< [lm/m^2 or W/m^2]
    /// Returns the mean over the channels, which is exact for grey surfaces.
    float mean_reflectance(PatchIndex patch) const { return channel_sum(reflectance(patch)) / 3; }
    void prefetch(PatchIndex patch) const { __builtin_prefetch(&scene_->patches[patch].material); }
    const Material& material(PatchIndex patch) const {
        if (!own_materials_.empty() && has_own_[patch]) return own_materials_[has_own_.rank(patch)];
        return scene_->materials[scene_->patches[patch].material];
    }

    MeanSurface surface(PatchIndex patch, ElementIndex element) const {
        if (!elements_.empty() && element != patch)
            if (const MeanSurface* known = elements_.find(element)) return *known;
        const Material& m = material(patch);
        return {m.reflectance, m.exitance, m.transmittance};
    }
    /// Returns the reflectance of surface() without the other properties.
    const Rgb& reflectance(PatchIndex patch, ElementIndex element) const {
        if (!elements_.empty() && element != patch)
            if (const MeanSurface* known = elements_.find(element)) return known->reflectance;
        return material(patch).reflectance;
    }
    float mean_reflectance(PatchIndex patch, ElementIndex element) const {
        return channel_sum(reflectance(patch, element)) / 3;
    }
    bool has_textures() const { return !elements_.empty(); }
    /// Computes the means of new elements. Until then, they have the mean of their patch.
    void grow(const ElementForest& forest) { elements_.grow(forest); }

  private:
    Materials(const Scene& scene, std::vector<float> exitance_share);

    const Scene* scene_;
    bool has_panes_;
    TexturedElements elements_;
    RankedBits has_own_;  // marks textured and partly covered patches
    std::vector<Material> own_materials_;
};

/// Returns Radiosity by element. With textures, inner elements have the mean of their children.
std::vector<Rgb> radiosity(const Materials& materials, const ElementForest& forest, const std::vector<Rgb>& irradiance);

/// Returns the sum of area times value over the patches, in fixed order.
RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values);

}  // namespace interflect::detail
