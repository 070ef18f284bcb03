#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/base/ranked_bits.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/ray_caster.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// What the surfaces of a scene do with light, by patch. Refers to the scene, which must outlive it.
///
/// Where faces coincide, one answers all rays: what emits and is covered by others has its exitance reduced to the
/// share of its area that is not (RayCaster::uncovered_share), so that no light is emitted twice from one place.
class Materials {
  public:
    /// As if no faces coincided.
    explicit Materials(const Scene& scene) : scene_(&scene) {}
    Materials(const Scene& scene, const RayCaster& ray_caster);

    const Rgb& reflectance(std::uint32_t patch) const { return material(patch).reflectance; }
    const Rgb& exitance(std::uint32_t patch) const { return material(patch).exitance; }  ///< [lm/m^2 or W/m^2]
    /// What importance, one number, is reflected with: exact for grey surfaces.
    float mean_reflectance(std::uint32_t patch) const { return channel_sum(reflectance(patch)) / 3; }
    /// Tells the processor that a patch will be asked for its material.
    void prefetch(std::uint32_t patch) const { __builtin_prefetch(&scene_->patches[patch].material); }
    const Material& material(std::uint32_t patch) const {
        if (!reduced_materials_.empty() && reduced_[patch]) return reduced_materials_[reduced_.rank(patch)];
        return scene_->materials[scene_->patches[patch].material];
    }

  private:
    const Scene* scene_;
    RankedBits reduced_;                       // patches that emit less than their material does
    std::vector<Material> reduced_materials_;  // of each of them; empty where no emitter is covered
};

/// What the faces that coincide with emitters take away from them.
struct CoveredEmission {
    std::int64_t wholly = 0, partly = 0;  ///< Emitting patches that others cover.
    RgbD power{0, 0, 0};                  ///< What they would emit there [lm or W].
};
/// @throws InputError for a ray caster of another scene.
CoveredEmission covered_emission(const Scene& scene, const RayCaster& ray_caster);

/// B = M + rho H of every element [lm/m^2 or W/m^2]. @param irradiance  H; size forest.size().
std::vector<Rgb> radiosity(const Materials& materials, const ElementForest& forest, const std::vector<Rgb>& irradiance);

/// Sum of area times value over the roots, in index order and double precision: the same for any number of threads.
RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values);

}  // namespace interflect
