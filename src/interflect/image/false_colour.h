#pragma once

#include <vector>

#include "interflect/core.h"
#include "interflect/image.h"

namespace interflect::detail {

/// Maps a number, clamped to [0, 1], to a colour: violet, teal, yellow. Lightness increases evenly and equal
/// steps look about equal, also in grey and to colour-blind viewers.
/// @return Linear Rec. 709 in [0, 1]; NaN for NaN.
Rgb false_colour(float position);

enum class Spacing {
    linear,
    logarithmic,  ///< Equal ratios look equal; 0 has the colour of the smallest value.
};

struct ColourScale {
    float low = 0, high = 1;  ///< Values at the ends, low < high; low > 0 if logarithmic.
    Spacing spacing = Spacing::linear;

    /// Returns the position of a value in [0, 1], clamped: `low` is 0, `high` is 1.
    float position(float value) const;
};

/// Fits a scale to the finite values. Linear: from 0, or a negative smallest value, to the largest. Logarithmic: at
/// most six decades of positive values, without the lowest and highest 0.5% (a dark crack, a lamp). Without values: 0
/// ... 1, or 0.1 ... 1 if logarithmic.
ColourScale fit_scale(std::vector<float> values, Spacing spacing);

/// Fits a linear scale from 0 to a round number that at most 2% of the positive, finite values exceed: 1, 1.5, 2, 3, 4,
/// 5, 6 or 8 times a power of ten. Without values: 0 ... 1.
ColourScale fit_round_scale(std::vector<float> values);

/// Converts the first channel of each pixel to its false colour. 0 becomes black; pixels that are not finite stay
/// unchanged.
Image false_colours(const Image& values, const ColourScale& scale);

}  // namespace interflect::detail
