#pragma once

#include <cstdint>
#include <vector>

#include "interflect/luminaires/illumination.h"
#include "interflect/render/light_tree.h"
#include "interflect/render/path_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples a luminaire by its unoccluded irradiance at a point. A LightTree proposes candidates; their exact irradiance
/// decides (resampled importance sampling, Talbot et al. 2005). Parallel light is always a candidate. The cost is
/// logarithmic in the number of other luminaires. Immutable, shared by all threads.
class LuminaireChoice {
  public:
    /// @param scene  Must outlive this object.
    explicit LuminaireChoice(const Scene& scene);

    /// Returns the light of one luminaire at the point x of a surface with normal n. The surface's irradiance is
    /// divided by the probability of the choice; its mean is the unoccluded irradiance by all luminaires.
    Illumination choose(const V3f& x, const V3f& n, const LightSample& sample) const;

  private:
    const Scene& scene_;
    std::vector<std::uint32_t> parallel_;  // indices of the directional lights
    LightTree tree_;
};

}  // namespace interflect::detail
