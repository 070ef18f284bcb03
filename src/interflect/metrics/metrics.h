#pragma once

#include <array>
#include <cstdint>

#include "interflect/image.h"

namespace interflect::inline detail {

/// Difference of luminances after averaging over square blocks of pixels, which reduces noise.
struct BlockDifference {
    int block = 1;  ///< Side [pixels]; what is left over at the right and at the bottom does not count.
    /// sqrt(mean of ((A - B) / (B + 0.01 m))^2), A and B mean luminances of a block, m that of the whole reference.
    double relative_rmse = 0;
    double trimmed_relative_rmse = 0;  ///< The same without the worst 1% of blocks (lamps and edges).
};

/// How an image differs from a reference; all 0, and ratio_of_means 1, for equal images. a and b are linear values,
/// means are over all pixels and, where not said to be of luminance, over the three channels.
struct ImageDifference {
    double ratio_of_means = 1;  ///< Mean luminance of the image over that of the reference.
    double rmse = 0;            ///< sqrt(mean of (a - b)^2) [unit of the images].
    /// Mean of (a - b)^2 / (b^2 + (0.01 m)^2); m is the reference's mean luminance, so that the unit does not matter.
    double relative_mse = 0;
    double maximum = 0;              ///< Largest |a - b| [unit of the images].
    double perceptual_distance = 0;  ///< Weighted by what the eye sees: perceptual.h.
    double flip = 0;                 ///< Mean of flip_map.
    std::array<BlockDifference, 3> blocks{{{1, 0, 0}, {5, 0, 0}, {9, 0, 0}}};
    std::int64_t non_finite_pixels = 0;  ///< In either image; the measures are then not numbers.
    /// What someone sees who flips between the two pictures on a display: flip.h. Of the reference's size; empty where
    /// pixels are not finite.
    Image flip_map;
};

struct CompareOptions {
    /// Divide the image by ratio_of_means first (which is still reported), so that only the shape counts.
    bool scale = false;
    /// Of the pictures' view, vertical, full [degrees], in (0, 180); a View's own default. For perceptual_distance.
    double field_of_view = 45;
    /// The images are as a display shows them, in [0, 1], so that FLIP takes them as they are. Otherwise both are
    /// tone-mapped for it, with the reference's automatic_exposure() and Tonemap::filmic.
    bool tone_mapped = false;
};

/// Compares an image with a reference of the same size, or smaller by a whole factor: then each block of the image's
/// pixels is averaged. Measures of the form 0 / 0 are 0 (equal), x / 0 is infinite.
/// docs/metrics.md defines every measure.
/// @throws InputError where the image's size is no whole multiple of the reference's, or an option is out of range.
ImageDifference compare(const Image& image, const Image& reference, const CompareOptions& options = {});

}  // namespace interflect::inline detail
