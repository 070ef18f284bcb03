#pragma once

#include <cstdint>
#include <vector>

#include "interflect/luminaires/illumination.h"
#include "interflect/render/light_tree.h"
#include "interflect/render/path_samples.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Samples a luminaire for a point by its unoccluded irradiance. A LightTree proposes a few candidates; one of these is
/// chosen by its exact irradiance (resampled importance sampling, Talbot et al. 2005). Parallel light is always a
/// candidate. The cost is logarithmic in the number of luminaires with a position. Immutable, shared by all threads.
class LuminaireChoice {
  public:
    /// @param scene  Must outlive this object.
    explicit LuminaireChoice(const Scene& scene);

    /// Returns the light of one luminaire at the point x of a surface with normal n. Its irradiance of the surface is
    /// divided by the probability of the choice. The expected value is the unoccluded irradiance by all luminaires.
    Illumination choose(const V3f& x, const V3f& n, const LightSample& sample) const;

  private:
    const Scene& scene_;
    std::vector<std::uint32_t> parallel_;  // indices of the directional lights
    LightTree tree_;
};

}  // namespace interflect::inline detail
