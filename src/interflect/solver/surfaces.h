#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// What the surfaces of a scene do with light, by patch. Refers to the scene, which must outlive it.
class Surfaces {
  public:
    explicit Surfaces(const Scene& scene) : scene_(scene) {}

    const Rgb& reflectance(std::uint32_t patch) const { return material(patch).reflectance; }
    const Rgb& exitance(std::uint32_t patch) const { return material(patch).exitance; }  ///< [lm/m^2 or W/m^2]
    /// What importance, one number, is reflected with: exact for grey surfaces.
    float mean_reflectance(std::uint32_t patch) const { return channel_sum(reflectance(patch)) / 3; }
    /// Tells the processor that a patch will be asked for its material.
    void prefetch(std::uint32_t patch) const { __builtin_prefetch(&scene_.patches[patch].material); }
    const Material& material(std::uint32_t patch) const { return scene_.materials[scene_.patches[patch].material]; }

  private:
    const Scene& scene_;
};

/// B = M + rho H of every element [lm/m^2 or W/m^2]. @param irradiance  H; size forest.size().
std::vector<Rgb> radiosity(const Surfaces& surfaces, const ElementForest& forest, const std::vector<Rgb>& irradiance);

/// Sum of area times value over the roots, in index order and double precision: the same for any number of threads.
RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values);

}  // namespace interflect
