#include "interflect/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/image.h"

namespace interflect {

namespace {

/// Share of the mean luminance that is added to denominators, to limit relative differences in dark areas.
constexpr double dark_share = 0.01;
constexpr double trimmed_share = 0.99;  // share of the blocks in the trimmed error: those with the smallest differences

double quotient(double numerator, double denominator) { return numerator == 0 ? 0 : numerator / denominator; }

Image at_size_of(const Image& reference, const Image& image) {
    const int factor = image.width / reference.width;
    if (factor < 1 || image.width != factor * reference.width || image.height != factor * reference.height)
        throw InputError(
            fmt::format("cannot compare an image of {} x {} pixels with a reference of {} x {}: expected "
                        "the same size or a whole multiple of it",
                        image.width, image.height, reference.width, reference.height));
    return box_downsample(image, factor);
}

std::vector<double> luminances(const Image& image) {
    std::vector<double> values;
    values.reserve(image.pixels.size());
    for (const Rgb& pixel : image.pixels) values.push_back(luminance(RgbD(pixel)));
    return values;
}

double mean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

std::vector<double> block_means(const std::vector<double>& values, int width, int height, int block) {
    std::vector<double> means;
    for (int top = 0; top + block <= height; top += block)
        for (int left = 0; left + block <= width; left += block) {
            double sum = 0;
            for (int y = top; y < top + block; ++y)
                for (int x = left; x < left + block; ++x)
                    sum += values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x)];
            means.push_back(sum / block / block);
        }
    return means;
}

BlockDifference block_difference(std::span<const double> image, std::span<const double> reference, double dark,
                                 int block) {
    std::vector<double> squares;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double relative = quotient(image[i] - reference[i], reference[i] + dark);
        squares.push_back(relative * relative);
    }
    std::sort(squares.begin(), squares.end());
    const auto kept = static_cast<std::size_t>(trimmed_share * static_cast<double>(squares.size()));
    const auto root_mean = [&](std::size_t count) {
        return count == 0 ? 0.0 : std::sqrt(mean(std::span(squares).first(count)));
    };
    return {block, root_mean(squares.size()), root_mean(kept)};
}

void add_pixel_measures(const Image& image, const Image& reference, double dark, ImageDifference& difference) {
    double squares = 0, relative_squares = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double b = reference.pixels[i][c], error = image.pixels[i][c] - b;
            squares += error * error;
            relative_squares += quotient(error * error, b * b + dark * dark);
            difference.maximum = std::max(difference.maximum, std::abs(error));
        }
    const double count = 3 * static_cast<double>(image.pixels.size());
    difference.rmse = std::sqrt(squares / count);
    difference.relative_mse = relative_squares / count;
}

void add_flip(const Image& image, const Image& reference, bool tone_mapped, ImageDifference& difference) {
    const float exposure = automatic_exposure(reference);
    const auto shown = [&](const Image& light) { return tone_map(light, exposure, Tonemap::filmic); };
    difference.flip_map = tone_mapped ? flip_map(image, reference) : flip_map(shown(image), shown(reference));
    double sum = 0;
    for (const Rgb& pixel : difference.flip_map.pixels) sum += pixel.x;
    difference.flip = sum / static_cast<double>(difference.flip_map.pixels.size());
}

ImageDifference not_a_number(std::int64_t non_finite_pixels) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {.ratio_of_means = nan,
            .rmse = nan,
            .relative_mse = nan,
            .maximum = nan,
            .perceptual_distance = nan,
            .flip = nan,
            .blocks = {{{1, nan, nan}, {5, nan, nan}, {9, nan, nan}}},
            .non_finite_pixels = non_finite_pixels,
            .flip_map = {}};
}

}  // namespace

ImageDifference compare(const Image& full_size_image, const Image& reference, const CompareOptions& options) {
    require_pixels(reference);
    Image image = at_size_of(reference, full_size_image);
    if (const auto count = count_non_finite(full_size_image) + count_non_finite(reference)) return not_a_number(count);

    ImageDifference difference;
    const std::vector<double> expected = luminances(reference);
    const double reference_mean = mean(expected), image_mean = mean(luminances(image));
    if (image_mean != reference_mean) difference.ratio_of_means = image_mean / reference_mean;
    if (options.scale && difference.ratio_of_means > 0)
        for (Rgb& pixel : image.pixels) pixel /= static_cast<float>(difference.ratio_of_means);

    const double dark = dark_share * reference_mean;
    add_pixel_measures(image, reference, dark, difference);
    const std::vector<double> found = luminances(image);
    for (BlockDifference& blocks : difference.blocks)
        blocks = block_difference(block_means(found, image.width, image.height, blocks.block),
                                  block_means(expected, image.width, image.height, blocks.block), dark, blocks.block);
    difference.perceptual_distance = perceptual_distance(image, reference, options.field_of_view);
    add_flip(image, reference, options.tone_mapped, difference);
    return difference;
}

}  // namespace interflect
