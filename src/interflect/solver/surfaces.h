#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/colour.h"
#include "interflect/scene/patch_geometry.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// What the solver asks of a scene's patches, gathered for fast access. Refers to the scene, which must outlive it.
class Surfaces {
  public:
    explicit Surfaces(const Scene& scene);

    std::size_t size() const { return geometry_.size(); }
    const PatchGeometry& geometry(std::size_t i) const { return geometry_[i]; }
    float area(std::size_t i) const { return geometry_[i].area(); }  ///< [m^2]
    const Rgb& reflectance(std::size_t i) const { return scene_.materials[scene_.patches[i].material].reflectance; }
    const Rgb& exitance(std::size_t i) const { return scene_.materials[scene_.patches[i].material].exitance; }

  private:
    const Scene& scene_;
    std::vector<PatchGeometry> geometry_;
};

/// P_i = A_i (M_i + rho_i H_i), the power that leaves each patch (radiosity B = M + rho H times area) [lm or W].
/// @param irradiance  H_i, size surfaces.size() [lm/m^2 or W/m^2].
std::vector<Rgb> radiated_power(const Surfaces& surfaces, const std::vector<Rgb>& irradiance);

/// Sum in index order, in double precision: the same bits for any number of threads.
RgbD total(const std::vector<Rgb>& values);

}  // namespace interflect
