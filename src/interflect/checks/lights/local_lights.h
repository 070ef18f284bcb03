#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Up to 1024 emitting point lights, spots and measured lights, with rays distributed by intensity.
class LocalLights {
  public:
    explicit LocalLights(const Scene& scene);

    static constexpr std::size_t rays_per_light = 256;

    std::size_t size() const { return luminaires_.size(); }
    const Luminaire& luminaire(std::size_t i) const { return luminaires_[i]; }
    V3f position(std::size_t i) const;
    /// Returns a point just in front of the surface that contains the luminaire.
    V3f in_front_of(std::size_t i) const;
    /// Returns rays in groups of equal power; those of measured light start in its opening.
    std::span<const Ray> rays(std::size_t i) const { return {rays_.data() + i * rays_per_light, rays_per_light}; }

  private:
    std::vector<Luminaire> luminaires_;
    std::vector<Ray> rays_;
    float reach_ = 0;  // largest coordinate [m]
};

}  // namespace interflect::detail
