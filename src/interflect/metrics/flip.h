#pragma once

#include <numbers>

#include "interflect/image.h"

namespace interflect::inline detail {

/// Viewing conditions of the pictures.
struct FlipOptions {
    /// Display pixels per degree of the observer's field of view, in (0, 1000]. Default of the paper: a display 0.7 m
    /// wide with 3840 pixels across, at a distance of 0.7 m; 67.02.
    double pixels_per_degree = 3840 * std::numbers::pi / 180;
};

/// Computes FLIP, the visible difference of each pixel when a viewer alternates between two pictures (Andersson et al.
/// 2020, 'FLIP: A Difference Evaluator for Alternating Images'). It combines colour differences, after removal of
/// invisible detail, with differences of edges and points. docs/metrics.md has the formulas.
/// @param image      Tone-mapped, linear Rec. 709; clamped to [0, 1].
/// @param reference  Tone-mapped, of the same size. The result is symmetric in both.
/// @return           0 (equal) to 1 (largest difference), in all three channels. Border pixels are repeated outside the
/// picture. The same bits for any number of threads.
/// @throws InputError if the sizes differ, there are no pixels, or an option is out of range. Pixels must be finite.
/// Cost: O(N pixels_per_degree) time, about 60 bytes per pixel.
Image flip_map(const Image& image, const Image& reference, const FlipOptions& options = {});

/// Converts a flip_map() to false colours and adds a legend.
Image show_flip_map(const Image& map);

}  // namespace interflect::inline detail
