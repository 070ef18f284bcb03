#include "interflect/render/pictures/pixel_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace interflect::detail {

namespace {

/// On both axes [pixels].
constexpr int neighbourhood_radius = 3;

double mean_reflected(const std::vector<PixelStatistics>& pixels) {
    double sum = 0;
    for (const PixelStatistics& p : pixels) sum += p.reflected();
    return sum / static_cast<double>(pixels.size());
}

double error_scale(const PixelStatistics& p, double picture_mean) {
    return std::max(mean_channel(p.mean), picture_mean);
}

std::vector<double> mean_along(const std::vector<double>& values, std::size_t lines, std::size_t line_step,
                               std::size_t length, std::size_t step) {
    std::vector<double> means(values.size());
    for (std::size_t line = 0; line < lines; ++line)
        for (std::size_t i = 0; i < length; ++i) {
            const std::size_t first = i - std::min<std::size_t>(i, neighbourhood_radius);
            const std::size_t end = std::min(length, i + neighbourhood_radius + 1);
            double sum = 0;
            for (std::size_t k = first; k < end; ++k) sum += values[line * line_step + k * step];
            means[line * line_step + i * step] = sum / static_cast<double>(end - first);
        }
    return means;
}

}  // namespace

double relative_error(const std::vector<PixelStatistics>& pixels) {
    const auto has_spread = [](const PixelStatistics& p) { return p.batches > 1; };
    if (!std::all_of(pixels.begin(), pixels.end(), has_spread)) return std::numeric_limits<double>::infinity();
    const double picture_mean = mean_reflected(pixels);
    double sum = 0;
    for (const PixelStatistics& p : pixels) {
        const double scale = error_scale(p, picture_mean);
        if (scale > 0) sum += mean_channel(p.squared_error()) / (scale * scale);
    }
    return std::sqrt(sum / static_cast<double>(pixels.size()));
}

std::vector<double> needed_batches(const std::vector<PixelStatistics>& pixels, const PictureOptions& options,
                                   double target) {
    const double picture_mean = mean_reflected(pixels);
    std::vector<double> variance(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double scale = error_scale(pixels[i], picture_mean);
        variance[i] = scale > 0 ? mean_channel(pixels[i].variance()) / (scale * scale) : 0;
    }
    const auto width = static_cast<std::size_t>(options.width), height = static_cast<std::size_t>(options.height);
    variance = mean_along(variance, height, width, width, 1);
    variance = mean_along(variance, width, 1, height, width);
    for (double& v : variance) v /= target * target;
    return variance;
}

}  // namespace interflect::detail
