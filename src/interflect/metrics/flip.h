#pragma once

#include <numbers>

#include "interflect/image.h"

namespace interflect::detail {

struct FlipOptions {
    /// In (0, 1000]. Default of the paper: 3840 pixels on 0.7 m, seen from 0.7 m.
    double pixels_per_degree = 3840 * std::numbers::pi / 180;
};

/// Computes FLIP, the visible difference of alternating pictures (Andersson et al. 2020; docs/metrics.md).
/// @param image      Tone-mapped, linear Rec. 709; clamped to [0, 1].
/// @param reference  Of the same size; the result is symmetric.
/// @return           0 (equal) to 1, in all channels; the same for any number of threads.
/// @throws InputError for different sizes, no pixels, or options out of range. Pixels must be finite.
/// O(N pixels_per_degree) time.
Image flip_map(const Image& image, const Image& reference, const FlipOptions& options = {});

Image show_flip_map(const Image& map);

}  // namespace interflect::detail
