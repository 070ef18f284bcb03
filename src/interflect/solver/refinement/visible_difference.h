#pragma once

#include <cstdint>

#include "interflect/solver/state/light_state.h"

namespace interflect::detail {

/// Just noticeable differences (JND) in tone-mapped pictures on a display (docs/method/method.md, Visible differences).
class VisibleDifference {
  public:
    /// Requires full importance. The arguments must outlive this. Cost: O(elements).
    explicit VisibleDifference(const RunInputs& inputs, const LightState& light);

    /// Returns the smallest mean squared difference of a leaf's children that is visible directly [(lm/m^2)^2 or
    /// (W/m^2)^2]. Infinite for black leaves and for leaves outside all views.
    float threshold(ElementIndex leaf) const;

    /// Returns the smallest misplaced power, times importance, that is visible in the light of other surfaces, relative
    /// to the light in the pictures: the JND of one square degree.
    double share_of_light() const { return share_of_light_; }

  private:
    float adapted_luminance(ElementIndex leaf, float pixels) const;
    float masking_contrast(ElementIndex leaf) const;

    const RunInputs& inputs_;
    const LightState& light_;
    float exposure_ = 0;  // display luminance [cd/m^2] per reflected light [lm/m^2 or W/m^2]
    double share_of_light_ = 0;
};

/// Returns the factor by which a masker of `contrast` [JND] raises the threshold, >= 1 (Daly 1993).
float threshold_elevation(float contrast);

}  // namespace interflect::detail
