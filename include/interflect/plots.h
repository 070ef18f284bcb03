/// @file
/// Numbers as pictures: colour scales, false colours, lines of equal value, legends.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/image.h"

namespace interflect {

/// Maps positions to violet, teal and yellow in about equal perceived steps, also in grey. Returns linear Rec. 709; NaN
/// for NaN.
/// @param position  Clamped to [0, 1].
Rgb false_colour(float position);

enum class Spacing {
    linear,
    logarithmic,  ///< The value 0 has the colour of the smallest value.
};

struct ColourScale {
    float low = 0, high = 1;  ///< low < high; low > 0 if logarithmic
    Spacing spacing = Spacing::linear;

    /// Returns 0 at `low` and 1 at `high`; clamped.
    float position(float value) const;
};

/// Fits a scale to the finite values. A linear scale extends from 0, or from a negative minimum, to the maximum. A
/// logarithmic scale has at most six decades of the positive values, without 0.5% of them at each end. Without values,
/// `high` is 1.
ColourScale fit_scale(std::vector<float> values, Spacing spacing);

/// Fits a linear scale from 0 to a round number that at most 2% of the positive, finite values exceed.
ColourScale fit_round_scale(std::vector<float> values);

/// Converts the first channel to false colours. 0 becomes black; non-finite pixels are unchanged.
Image false_colours(const Image& values, const ColourScale& scale);

/// Draws anti-aliased lines of equal value. Long lines have labels, short lines are omitted, and lines end at jumps.
/// @param picture  Picture in false colours.
/// @param values   Values in the first channel; 0 replaces non-finite values.
/// @throws InputError if the sizes differ.
Image with_isolines(const Image& picture, const Image& values, std::span<const float> levels, const ColourScale& scale);

/// Adds a title and a colour strip below a picture; clips parts without room.
/// @param picture  Tone-mapped, linear Rec. 709 in [0, 1].
/// @param title    Printable ASCII.
/// @throws InputError for more than max_image_pixels or an invalid title or scale.
Image with_legend(const Image& picture, const ColourScale& scale, const std::string& title);

/// Returns the height of a legend for a picture of this width [pixels].
int legend_height(int width);

/// Returns whether the whole legend takes at most half of the picture. @throws InputError for an invalid title.
bool legend_fits(int width, int height, const std::string& title);

/// Returns at most `most` round values in ascending order: 1, 2 and 5 times powers of ten, or multiples of such a
/// number.
/// @throws InputError if `most` < 3 or the scale is invalid.
std::vector<float> round_values(const ColourScale& scale, int most);

}  // namespace interflect
