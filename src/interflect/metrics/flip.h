#pragma once

#include <numbers>

#include "interflect/image.h"

namespace interflect::inline detail {

/// How the pictures are looked at.
struct FlipOptions {
    /// Pixels of the display in one degree of what the observer sees, in (0, 1000]. The default is the paper's: a
    /// display 0.7 m wide, with 3840 pixels across, from 0.7 m away; 67.02.
    double pixels_per_degree = 3840 * std::numbers::pi / 180;
};

/// FLIP: how different each pixel looks to someone who flips between the two pictures on a display, Andersson et al.
/// 2020, 'FLIP: A Difference Evaluator for Alternating Images'. It joins the difference of colours, after details too
/// fine for the eye were filtered out, with the difference of edges and points. docs/metrics.md has the formulas.
/// @param image      As a display shows it (tone-mapped): linear Rec. 709 in [0, 1], to which it is clamped.
/// @param reference  Likewise, of the same size. The two may be exchanged.
/// @return           0 (equal) to 1 (as different as can be), in all three channels. Beyond the borders the pictures go
///                   on as at the border. The same bits for any number of threads.
/// @throws InputError where the sizes differ, there are no pixels, or an option is out of range. Pixels must be finite.
/// Cost: O(N pixels_per_degree) time, about 60 bytes a pixel.
Image flip_map(const Image& image, const Image& reference, const FlipOptions& options = {});

/// A flip_map() for people: in false colours, with a legend below.
Image show_flip_map(const Image& map);

}  // namespace interflect::inline detail
