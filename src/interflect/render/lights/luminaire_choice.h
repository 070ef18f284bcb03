#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/luminaires/illumination.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Samples a luminaire by unoccluded irradiance (resampled importance sampling, Talbot et al. 2005). Excludes skies.
/// Constant methods are thread-safe.
class LuminaireChoice {
  public:
    /// @param scene  Must outlive this.
    explicit LuminaireChoice(const Scene& scene);

    struct Group {
        std::uint32_t count = 0;
        bool has_extent = false;  ///< Whether a luminaire of the group has an extent. All rays to a point are equal.
    };
    const Group& lamps() const { return lamps_; }
    const Group& suns() const { return suns_; }

    /// Calls LightTree::weigh() for luminaires with a position. @param weights  By index in the scene.
    void weigh_lamps(std::span<const float> weights) { tree_.weigh(weights); }

    struct Chosen {
        std::uint32_t luminaire = none;
        Illumination light;  ///< Illumination times the cosine, over the probability of the choice.
    };
    /// Chooses a luminaire with a position; a LightTree proposes candidates.
    Chosen choose_lamp(const V3f& x, const V3f& n, const LightSample& sample) const;
    /// Chooses among all directional lights.
    Chosen choose_sun(const V3f& x, const V3f& n, const LightSample& sample) const;

  private:
    const Scene& scene_;
    std::vector<std::uint32_t> directional_;
    LightTree tree_;
    Group lamps_, suns_;
};

}  // namespace interflect::detail
