#pragma once

#include <array>
#include <cstdint>

#include "interflect/image.h"

namespace interflect::detail {

/// Difference of luminances averaged over square blocks, to reduce noise.
struct BlockDifference {
    int block = 1;  ///< [pixels]; ignores incomplete blocks.
    /// sqrt(mean of ((A - B) / (B + 0.01 m))^2) of block means A, B; m is the reference's mean.
    double relative_rmse = 0;
    double trimmed_relative_rmse = 0;  ///< Without the worst 1% of blocks.
};

/// Image a minus reference b. Means include pixels and, except for luminance, channels.
struct ImageDifference {
    double ratio_of_means = 1;  ///< Mean luminance: image / reference.
    double rmse = 0;            ///< sqrt(mean of (a - b)^2) [unit of the images].
    /// Mean of (a - b)^2 / (b^2 + (0.01 m)^2), m the mean luminance of b.
    double relative_mse = 0;
    double maximum = 0;              ///< Largest |a - b| [unit of the images].
    double perceptual_distance = 0;  ///< perceptual.h.
    double flip = 0;                 ///< Mean of flip_map.
    std::array<BlockDifference, 3> blocks{{{1, 0, 0}, {5, 0, 0}, {9, 0, 0}}};
    std::int64_t non_finite_pixels = 0;  ///< If > 0, measures are NaN.
    /// Empty if pixels are not finite.
    Image flip_map;
};

struct CompareOptions {
    /// Divides the image by ratio_of_means first.
    bool scale = false;
    /// Vertical [degrees], in (0, 180).
    double field_of_view = 45;
    /// Otherwise FLIP uses the reference's automatic_exposure() and Tonemap::filmic.
    bool tone_mapped = false;
};

/// Averages blocks of an image larger than the reference by a whole factor. 0 / 0 counts as 0, x / 0 as infinite
/// (docs/metrics.md).
/// @throws InputError for other sizes or an option out of range.
ImageDifference compare(const Image& image, const Image& reference, const CompareOptions& options = {});

}  // namespace interflect::detail
