#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <kissfft/kissfft.hh>
#include <limits>
#include <vector>

#include "interflect/core.h"
#include "interflect/image/tone/visual_adaptation.h"
#include "interflect/metrics.h"

namespace interflect {

using namespace detail;

namespace {

using Complex = std::complex<double>;

constexpr double response_exponent = 0.33;  // of the eye [Mannos and Sakrison 1974]

double lit_luminance(const Rgb& pixel) { return std::max(luminance(RgbD(pixel)), 0.0); }

double mean_luminance(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels) sum += lit_luminance(pixel);
    return sum / static_cast<double>(image.pixels.size());
}

/// @param mean  Adaptation luminance, > 0.
std::vector<Complex> response_differences(const Image& image, const Image& reference, double mean) {
    const auto response = [&](const Rgb& pixel) { return std::pow(lit_luminance(pixel) / mean, response_exponent); };
    std::vector<Complex> differences;
    differences.reserve(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        differences.emplace_back(response(image.pixels[i]) - response(reference.pixels[i]));
    return differences;
}

/// Returns the frequency of coefficient k of n. The upper half of the coefficients has negative frequencies.
double cycles_per_pixel(std::size_t k, std::size_t n) {
    return static_cast<double>(std::min(k, n - k)) / static_cast<double>(n);
}

void transform_rows(std::vector<Complex>& values, std::size_t width) {
    const kissfft<double> fourier(width, false);
    std::vector<Complex> spectrum(width);
    for (auto row = values.begin(); row != values.end(); row += static_cast<std::ptrdiff_t>(width)) {
        fourier.transform(&*row, spectrum.data());
        std::copy(spectrum.begin(), spectrum.end(), row);
    }
}

/// Returns the sum of A^2 |D|^2: contrast sensitivity A, spectrum D of the response differences.
/// @param rows  Response differences after transform_rows().
double weighted_power(const std::vector<Complex>& rows, std::size_t width, double pixels_per_degree) {
    const std::size_t height = rows.size() / width;
    const kissfft<double> fourier(height, false);
    std::vector<Complex> spectrum(height);
    double power = 0;
    for (std::size_t u = 0; u < width; ++u) {
        fourier.transform(&rows[u], spectrum.data(), 0, 1, width);
        for (std::size_t v = 0; v < height; ++v) {
            const double frequency = std::hypot(cycles_per_pixel(u, width), cycles_per_pixel(v, height));
            const double seen = contrast_sensitivity(pixels_per_degree * frequency);
            power += seen * seen * std::norm(spectrum[v]);
        }
    }
    const auto count = static_cast<double>(rows.size());  // kissfft omits the factor 1/N
    return power / (count * count);
}

}  // namespace

double perceptual_distance(const Image& image, const Image& reference, double field_of_view) {
    require_same_size(image, reference);
    if (!(field_of_view > 0 && field_of_view < 180))
        throw InputError(fmt::format("a field of view of {} degrees: expected above 0 and below 180", field_of_view));
    const double mean = mean_luminance(reference);
    if (mean == 0) return mean_luminance(image) == 0 ? 0 : std::numeric_limits<double>::infinity();

    const auto width = static_cast<std::size_t>(image.width);
    std::vector<Complex> values = response_differences(image, reference, mean);
    transform_rows(values, width);
    return std::sqrt(weighted_power(values, width, image.height / field_of_view));
}

}  // namespace interflect
