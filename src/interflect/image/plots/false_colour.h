#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Maps positions to violet, teal and yellow in about equal perceived steps, also in grey. Returns linear Rec. 709; NaN
/// for NaN.
/// @param position  Clamped to [0, 1].
Rgb false_colour(float position);

enum class Spacing {
    linear,
    logarithmic,  ///< 0 has the colour of the smallest value.
};

struct ColourScale {
    float low = 0, high = 1;  ///< low < high; low > 0 if logarithmic
    Spacing spacing = Spacing::linear;

    /// Returns 0 at `low` and 1 at `high`; clamped.
    float position(float value) const;
};

/// Fits a scale to the finite values. Linear: from 0, or a negative minimum, to the maximum. Logarithmic: at most six
/// decades of positive values, without 0.5% at each end. Without values, `high` is 1.
ColourScale fit_scale(std::vector<float> values, Spacing spacing);

/// Fits a linear scale from 0 to a round number that at most 2% of the positive, finite values exceed.
ColourScale fit_round_scale(std::vector<float> values);

/// Converts the first channel. 0 becomes black; non-finite pixels stay unchanged.
Image false_colours(const Image& values, const ColourScale& scale);

}  // namespace interflect::detail
