#pragma once

#include <numbers>

#include "interflect/image.h"

namespace interflect::detail {

struct FlipOptions {
    /// Display pixels per degree of the field of view, in (0, 1000]. Default of the paper: 3840 pixels on 0.7 m, seen
    /// from 0.7 m; 67.02.
    double pixels_per_degree = 3840 * std::numbers::pi / 180;
};

/// Computes FLIP, the visible difference per pixel for a viewer who alternates between two pictures (Andersson et al.
/// 2020, 'FLIP: A Difference Evaluator for Alternating Images'). It combines differences of visible colours with
/// differences of edges and points; formulas in docs/metrics.md.
/// @param image      Tone-mapped, linear Rec. 709; clamped to [0, 1].
/// @param reference  The same, of the same size. The result is symmetric.
/// @return           0 (equal) to 1, in all three channels. Border pixels are repeated outside. The same bits for any
///                   number of threads.
/// @throws InputError for different sizes, no pixels, or options out of range. Pixels must be finite.
/// Cost: O(N pixels_per_degree) time, about 60 bytes per pixel.
Image flip_map(const Image& image, const Image& reference, const FlipOptions& options = {});

/// Converts a flip_map() to false colours and adds a legend.
Image show_flip_map(const Image& map);

}  // namespace interflect::detail
