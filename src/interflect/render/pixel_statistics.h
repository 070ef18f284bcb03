#pragma once

#include <cstdint>
#include <vector>

#include "interflect/colour.h"
#include "interflect/path_tracer.h"
#include "interflect/render/path_wavefront.h"

namespace interflect::inline detail {

/// Mean of the channels.
inline double mean_channel(const RgbD& c) { return channel_sum(c) / 3; }

/// Mean and variance of a pixel's batches, gathered one by one (Welford 1962).
struct PixelStatistics {
    RgbD mean{0, 0, 0}, squares{0, 0, 0};                       // squares: sum of squared differences from the mean
    RgbD emitted{0, 0, 0}, direct{0, 0, 0}, indirect{0, 0, 0};  // means of the parts
    double direct_squares = 0, indirect_squares = 0;            // of the channels' means
    FirstHit first;                                             // means
    std::uint32_t batches = 0;

    void add(const BatchOfPaths& b, double batch_size) {
        ++batches;
        const double count = batches;
        const RgbD value = (b.emitted + b.direct + b.indirect) / batch_size, difference = value - mean;
        mean += difference / count;
        squares += difference * (value - mean);
        emitted += (b.emitted / batch_size - emitted) / count;
        add_part(b.direct / batch_size, direct, direct_squares);
        add_part(b.indirect / batch_size, indirect, indirect_squares);
        first.albedo += (b.first.albedo / batch_size - first.albedo) / count;
        first.normal += (b.first.normal / batch_size - first.normal) / count;
        first.position += (b.first.position / batch_size - first.position) / count;
        first.distance += (b.first.distance / batch_size - first.distance) / count;
        first.level += (b.first.level / batch_size - first.level) / count;
    }
    /// Mean of the channels of what is reflected.
    double reflected() const { return mean_channel(direct + indirect); }
    /// Of one batch.
    RgbD variance() const { return batches > 1 ? squares / (batches - 1.0) : RgbD(0, 0, 0); }
    RgbD squared_error() const { return batches > 1 ? variance() / static_cast<double>(batches) : RgbD(0, 0, 0); }
    /// Of the mean of a part's channels. @param part_squares  direct_squares or indirect_squares.
    double squared_error(double part_squares) const {
        return batches > 1 ? part_squares / (batches - 1.0) / static_cast<double>(batches) : 0;
    }

  private:
    void add_part(const RgbD& value, RgbD& part, double& part_squares) const {
        const RgbD difference = value - part;
        part += difference / static_cast<double>(batches);
        part_squares += mean_channel(difference) * mean_channel(value - part);
    }
};

/// The root mean square over the pixels of standard error over mean, each pixel's mean at least the mean over the
/// picture of what is reflected; infinite where a pixel has fewer than two batches.
double relative_error(const std::vector<PixelStatistics>& pixels);

/// How many batches each pixel should have in all for the target, options.until, by the variance around it.
std::vector<double> needed_batches(const std::vector<PixelStatistics>& pixels, const PathOptions& options);

}  // namespace interflect::inline detail
