#pragma once

#include <array>
#include <cstdint>

#include "interflect/image.h"

namespace interflect::detail {

/// Difference of luminances averaged over square blocks, which reduces noise.
struct BlockDifference {
    int block = 1;  ///< Side [pixels]; incomplete blocks at the right and bottom are ignored.
    /// sqrt(mean of ((A - B) / (B + 0.01 m))^2): mean luminances A, B of a block and m of the reference.
    double relative_rmse = 0;
    double trimmed_relative_rmse = 0;  ///< Without the worst 1% of the blocks (lamps and edges).
};

/// Differences from a reference; all 0, and ratio_of_means 1, for equal images. a and b are linear values. Means are
/// over pixels and, except for luminance, channels.
struct ImageDifference {
    double ratio_of_means = 1;  ///< Mean luminance: image / reference.
    double rmse = 0;            ///< sqrt(mean of (a - b)^2) [unit of the images].
    /// Mean of (a - b)^2 / (b^2 + (0.01 m)^2), m the reference's mean luminance; independent of the unit.
    double relative_mse = 0;
    double maximum = 0;              ///< Largest |a - b| [unit of the images].
    double perceptual_distance = 0;  ///< Weighted by contrast sensitivity: perceptual.h.
    double flip = 0;                 ///< Mean of flip_map.
    std::array<BlockDifference, 3> blocks{{{1, 0, 0}, {5, 0, 0}, {9, 0, 0}}};
    std::int64_t non_finite_pixels = 0;  ///< In either image; if > 0, the measures are NaN.
    /// Visible difference per pixel (flip.h), of the reference's size; empty if pixels are not finite.
    Image flip_map;
};

struct CompareOptions {
    /// Divides the image by ratio_of_means first; the ratio is still reported.
    bool scale = false;
    /// Full vertical angle of the view [degrees], in (0, 180); View's default. For perceptual_distance.
    double field_of_view = 45;
    /// The images are tone-mapped, in [0, 1]. Otherwise FLIP tone-maps both with the reference's automatic_exposure()
    /// and Tonemap::filmic.
    bool tone_mapped = false;
};

/// Compares an image with a reference of the same size, or smaller by a whole factor: then blocks of the image are
/// averaged. 0 / 0 counts as 0 (equal), x / 0 as infinite. docs/metrics.md defines every measure.
/// @throws InputError for other sizes or an option out of range.
ImageDifference compare(const Image& image, const Image& reference, const CompareOptions& options = {});

}  // namespace interflect::detail
