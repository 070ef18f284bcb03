#pragma once

#include <cstdint>
#include <vector>

#include "interflect/luminaires/illumination.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples a luminaire by unoccluded irradiance (resampled importance sampling, Talbot et al. 2005). A LightTree
/// proposes candidates; directional lights always are. Thread-safe.
class LuminaireChoice {
  public:
    /// @param scene  Must outlive this.
    explicit LuminaireChoice(const Scene& scene);

    /// Returns one luminaire's light at x, divided by its probability. Excludes skies.
    Illumination choose(const V3f& x, const V3f& n, const LightSample& sample) const;

  private:
    const Scene& scene_;
    std::vector<std::uint32_t> parallel_;
    LightTree tree_;
};

}  // namespace interflect::detail
