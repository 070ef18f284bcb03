#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/ranked_bits.h"
#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solver/textured_elements.h"

namespace interflect::inline detail {

/// What the surfaces of a scene do with light, by patch and, where they are textured, by element: textures count by
/// their means. Refers to the scene, which must outlive it.
///
/// Where faces coincide, one answers all rays: what emits and is covered by others has its exitance reduced to the
/// share of its area that is not (RayCaster::uncovered_share), so that no light is emitted twice from one place.
class Materials {
  public:
    /// As if no faces coincided.
    explicit Materials(const Scene& scene) : Materials(scene, std::vector<float>()) {}
    Materials(const Scene& scene, const RayCaster& ray_caster);

    const Scene& scene() const { return *scene_; }
    /// Whether light goes through any material.
    bool has_panes() const { return has_panes_; }
    const Rgb& reflectance(std::uint32_t patch) const { return material(patch).reflectance; }
    const Rgb& exitance(std::uint32_t patch) const { return material(patch).exitance; }  ///< [lm/m^2 or W/m^2]
    /// What importance, one number, is reflected with: exact for grey surfaces.
    float mean_reflectance(std::uint32_t patch) const { return channel_sum(reflectance(patch)) / 3; }
    /// Tells the processor that a patch will be asked for its material.
    void prefetch(std::uint32_t patch) const { __builtin_prefetch(&scene_->patches[patch].material); }
    const Material& material(std::uint32_t patch) const {
        if (!own_materials_.empty() && has_own_[patch]) return own_materials_[has_own_.rank(patch)];
        return scene_->materials[scene_->patches[patch].material];
    }

    /// Of an element of `patch`.
    MeanSurface surface(std::uint32_t patch, std::uint32_t element) const {
        if (!elements_.empty() && element != patch)
            if (const MeanSurface* known = elements_.find(element)) return *known;
        const Material& m = material(patch);
        return {m.reflectance, m.exitance, m.transmittance};
    }
    float mean_reflectance(std::uint32_t patch, std::uint32_t element) const {
        return channel_sum(surface(patch, element).reflectance) / 3;
    }
    /// Whether elements of one patch may differ.
    bool has_textures() const { return !elements_.empty(); }
    /// To be called when the forest has grown: until then, new elements are as their patch.
    void grow(const ElementForest& forest) { elements_.grow(forest); }

  private:
    /// @param exitance_share  That each patch keeps; empty: all.
    Materials(const Scene& scene, std::vector<float> exitance_share);

    const Scene* scene_;
    bool has_panes_;
    TexturedElements elements_;
    RankedBits has_own_;                   // patches that are textured, or emit less than their material does
    std::vector<Material> own_materials_;  // of each of them
};

/// What the faces that coincide with emitters take away from them.
struct CoveredEmission {
    std::int64_t wholly = 0, partly = 0;  ///< Emitting patches that others cover.
    RgbD power{0, 0, 0};                  ///< What they would emit there [lm or W].
};
/// @throws InputError for a ray caster of another scene.
CoveredEmission covered_emission(const Scene& scene, const RayCaster& ray_caster);

/// B = M + rho H of every element [lm/m^2 or W/m^2]; where there are textures, B of an inner element is the mean of
/// its children's. @param irradiance  H; size forest.size().
std::vector<Rgb> radiosity(const Materials& materials, const ElementForest& forest, const std::vector<Rgb>& irradiance);

/// Sum of area times value over the roots, in index order and double precision: the same for any number of threads.
RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values);

}  // namespace interflect::inline detail
