#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Point lights, spots and measured lights of a scene that emit, at most 1024 of them, and 256 rays of each,
/// distributed by its intensities. The scene must have patches.
class LocalLights {
  public:
    explicit LocalLights(const Scene& scene);

    static constexpr std::size_t rays_per_light = 256;

    std::size_t size() const { return luminaires_.size(); }
    const Luminaire& luminaire(std::size_t i) const { return luminaires_[i]; }
    V3f position(std::size_t i) const;
    /// A point just before the surface that contains the luminaire.
    V3f before(std::size_t i) const;
    /// Rays of measured light start in its opening, each further along its direction by an eighth of the offset that
    /// Emission uses. Consecutive groups of equal size belong to parts of equal power.
    std::span<const Ray> rays(std::size_t i) const { return {rays_.data() + i * rays_per_light, rays_per_light}; }

  private:
    std::vector<Luminaire> luminaires_;
    std::vector<Ray> rays_;
    float reach_ = 0;  // largest coordinate [m]
};

}  // namespace interflect::detail
