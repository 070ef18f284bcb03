#pragma once

#include <vector>

#include "interflect/colour.h"
#include "interflect/image.h"

namespace interflect::inline detail {

/// A colour for a number in [0, 1] (others are clamped): violet, teal, yellow. Lightness rises evenly and equal steps
/// look about equally large, so that a picture reads right in grey and to colour-blind eyes too.
/// @return Linear Rec. 709 in [0, 1]; not a number for what is none.
Rgb false_colour(float position);

enum class Spacing {
    linear,
    logarithmic,  ///< Equal ratios look equal; 0 has the colour of the smallest value.
};

/// Which values have which colours.
struct ColourScale {
    float low = 0, high = 1;  ///< The values at the ends, low < high; 0 < low where logarithmic.
    Spacing spacing = Spacing::linear;

    /// Where a value lies between `low`, 0, and `high`, 1; in [0, 1], so what is beyond them looks like them.
    float position(float value) const;
};

/// The scale that shows these values best. Linear: from 0 to the largest. Logarithmic: what the lowest and the highest
/// 0.5% are does not count, so that neither a lamp nor a dark crack takes all the colours, and no more than six
/// decades. Values that are not finite do not count, nor do those <= 0 for a logarithmic scale; 0 ... 1 or 0.1 ... 1
/// where none is left.
ColourScale fit_scale(std::vector<float> values, Spacing spacing);

/// The linear scale from 0 to a round number that all but the highest 2% of the values above 0 do not exceed: 1, 1.5,
/// 2, 3, 4, 5, 6 or 8 times a power of ten. Values that are not finite do not count; 0 ... 1 where none is left.
ColourScale fit_round_scale(std::vector<float> values);

/// Each pixel's number in its false colour.
/// @param values  The first channel counts. 0 is black; what is not finite stays as it is.
Image false_colours(const Image& values, const ColourScale& scale);

}  // namespace interflect::inline detail
