#pragma once

#include <cstdint>
#include <vector>

#include "interflect/luminaires/illumination.h"
#include "interflect/render/light_tree.h"
#include "interflect/render/path_samples.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Chooses a luminaire that lights a point, by what it would bring if nothing were in its way: a few that come into
/// question are taken from a LightTree, and one of these by its exact irradiance (resampled importance sampling, Talbot
/// et al. 2005). Parallel light comes into question always. So the cost grows with the logarithm of the number of
/// luminaires that have a place. Immutable, shared by all threads.
class LuminaireChoice {
  public:
    /// @param scene  Must outlive this.
    explicit LuminaireChoice(const Scene& scene);

    /// Light that reaches the point x of a surface with normal n from one luminaire; with its irradiance, of that
    /// surface, divided by the chance of this choice, so that the mean over choices is what all luminaires cause.
    Illumination choose(const V3f& x, const V3f& n, const LightSample& sample) const;

  private:
    const Scene& scene_;
    std::vector<std::uint32_t> parallel_;  // indices of luminaires without a place
    LightTree tree_;
};

}  // namespace interflect::inline detail
