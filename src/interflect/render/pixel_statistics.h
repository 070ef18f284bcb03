#pragma once

#include <cstdint>
#include <vector>

#include "interflect/colour.h"
#include "interflect/path_tracer.h"
#include "interflect/render/path_wavefront.h"

namespace interflect {

/// Mean of the channels.
inline double mean_channel(const RgbD& c) { return channel_sum(c) / 3; }

/// Mean and variance of a pixel's batches, gathered one by one (Welford 1962).
struct PixelStatistics {
    RgbD mean{0, 0, 0}, squares{0, 0, 0};  // squares: sum of squared differences from the mean
    RgbD direct{0, 0, 0};                  // mean of what comes straight from where it is emitted
    double reflected = 0;                  // mean over the batches of the channels' mean
    std::uint32_t batches = 0;

    void add(const BatchOfPaths& b, double batch_size) {
        ++batches;
        const double count = batches;
        const RgbD value = (b.emitted + b.direct + b.indirect) / batch_size, difference = value - mean;
        mean += difference / count;
        squares += difference * (value - mean);
        direct += ((b.emitted + b.direct) / batch_size - direct) / count;
        reflected += (mean_channel(b.direct + b.indirect) / batch_size - reflected) / count;
    }
    /// Of one batch.
    RgbD variance() const { return batches > 1 ? squares / (batches - 1.0) : RgbD(0, 0, 0); }
    RgbD squared_error() const { return batches > 1 ? variance() / static_cast<double>(batches) : RgbD(0, 0, 0); }
};

/// The root mean square over the pixels of standard error over mean, each pixel's mean at least the mean over the
/// picture of what is reflected; infinite where a pixel has fewer than two batches.
double relative_error(const std::vector<PixelStatistics>& pixels);

/// How many batches each pixel should have in all for the target, options.until, by the variance around it.
std::vector<double> needed_batches(const std::vector<PixelStatistics>& pixels, const PathOptions& options);

}  // namespace interflect
