/// @file
/// Differences of pictures: errors of values, perceptual distance, FLIP. docs/method/metrics.md has the formulas.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "interflect/image.h"

namespace interflect {

/// Difference of luminances averaged over square blocks, which reduces noise.
struct BlockDifference {
    int block = 1;  ///< Side of a block [pixels]. Incomplete blocks are ignored.
    /// Relative root mean square error, sqrt(mean of ((A - B) / (B + 0.01 m))^2). A and B are the means of a block in
    /// the image and in the reference, m the mean luminance of the reference.
    double relative_rmse = 0;
    double trimmed_relative_rmse = 0;  ///< The same without the worst 1% of blocks.
};

/// Differences of an image a from a reference b. Means are over pixels and, except for luminance, over channels.
struct ImageDifference {
    double ratio_of_means = 1;  ///< Mean luminance of the image over the mean luminance of the reference.
    double rmse = 0;            ///< Root mean square error, sqrt(mean of (a - b)^2) [unit of the images].
    /// Mean of (a - b)^2 / (b^2 + (0.01 m)^2), with m the mean luminance of the reference (after Rousselle et al.
    /// 2011).
    double relative_mse = 0;
    double maximum = 0;              ///< Largest absolute difference [unit of the images].
    double perceptual_distance = 0;  ///< Difference that an observer in the scene sees (Rushmeier et al. 1995).
    double flip = 0;                 ///< Mean of `flip_map`, 0 to 1.
    /// Differences of blocks of 1, 5 and 9 pixels.
    std::array<BlockDifference, 3> blocks{{{1, 0, 0}, {5, 0, 0}, {9, 0, 0}}};
    std::int64_t non_finite_pixels = 0;  ///< Infinite or NaN pixels of both images. If > 0, all measures are NaN.
    /// Difference of each pixel that an observer of a display sees, 0 to 1 (FLIP, Andersson et al. 2020). Has the size
    /// of the reference; empty if any pixel is not finite.
    Image flip_map;
};

struct CompareOptions {
    bool scale = false;         ///< Whether to divide the image by ImageDifference::ratio_of_means first.
    double field_of_view = 45;  ///< Vertical angle of the pictures [degrees], in (0, 180), for the perceptual distance.
    /// Whether both are display values in [0, 1]. Otherwise FLIP compares them after the filmic curve
    /// (Tonemap::filmic), at the automatic_exposure() of the reference.
    bool tone_mapped = false;
};

/// Computes the difference of two pictures of the same light. A difference of 0 relative to 0 counts as 0, any other
/// one as infinite. Cost: O(N log N) for N pixels and sides with small prime factors.
/// @param image      Linear Rec. 709. If it is larger than the reference by a whole factor, blocks of its pixels are
///                   averaged first.
/// @param reference  Linear Rec. 709 in the same unit.
/// @return           The same bits for any number of threads.
/// @throws InputError for other sizes, an image without pixels, and an option out of range.
ImageDifference compare(const Image& image, const Image& reference, const CompareOptions& options = {});

/// Computes the first model of Rushmeier et al. 1995, after Mannos and Sakrison 1974, from luminances clamped to >= 0:
/// the root mean square difference of the eye's responses, weighted by its sensitivity to each spatial frequency. Cost:
/// O(N log N) for N pixels and sides with small prime factors, at worst O(N (width + height)).
/// @param image          Finite pixels.
/// @param reference      Of the same size and unit; the eye adapts to its mean luminance.
/// @param field_of_view  Full vertical angle [degrees], in (0, 180).
/// @return               >= 0. If the reference is black, 0 for a black image and infinity for any other.
/// @throws InputError for different sizes, no pixels, or a field of view out of range.
double perceptual_distance(const Image& image, const Image& reference, double field_of_view);

struct FlipOptions {
    /// Resolution of the display for its observer, in (0, 1000]. The default is that of the paper: 3840 pixels on 0.7
    /// m, seen from 0.7 m.
    double pixels_per_degree = 3840 * std::numbers::pi / 180;
};

/// Computes FLIP for displayed pictures, the difference that is visible when they alternate (Andersson et al. 2020).
/// Cost: O(N pixels_per_degree) for N pixels.
/// @param image      Display values, finite and linear Rec. 709; clamped to [0, 1]. See tone_map().
/// @param reference  Of the same size and kind. The result is symmetric.
/// @return           0 (equal) to 1 in all channels of each pixel; the same bits for any number of threads.
/// @throws InputError for different sizes, no pixels, or an option out of range.
Image flip_map(const Image& image, const Image& reference, const FlipOptions& options = {});

/// Draws the result of flip_map() for viewing, in false colours from violet (0) to yellow (1).
/// @return  Display values in [0, 1], linear Rec. 709: the map with a legend below it.
/// @throws InputError for a map without pixels.
Image show_flip_map(const Image& map);

}  // namespace interflect
