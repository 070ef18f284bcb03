#pragma once

#include <cstdint>
#include <vector>

#include "interflect/luminaires/illumination.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples a luminaire by unoccluded irradiance (resampled importance sampling, Talbot et al. 2005). Excludes skies.
/// Thread-safe.
class LuminaireChoice {
  public:
    /// @param scene  Must outlive this.
    explicit LuminaireChoice(const Scene& scene);

    struct Group {
        std::uint32_t count = 0;
        bool has_extent = false;  ///< Otherwise two rays to the same luminaire are equal.
    };
    const Group& lamps() const { return lamps_; }
    const Group& suns() const { return suns_; }

    /// Returns the light of one luminaire with a position, divided by its probability and multiplied by the cosine; a
    /// LightTree proposes candidates.
    Illumination choose_lamp(const V3f& x, const V3f& n, const LightSample& sample) const;
    /// The same among all directional lights.
    Illumination choose_sun(const V3f& x, const V3f& n, const LightSample& sample) const;

  private:
    const Scene& scene_;
    std::vector<std::uint32_t> parallel_;
    LightTree tree_;
    Group lamps_, suns_;
};

}  // namespace interflect::detail
