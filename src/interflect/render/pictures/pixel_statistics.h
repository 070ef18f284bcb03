#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/core.h"
#include "interflect/render.h"
#include "interflect/render/paths/part_statistics.h"
#include "interflect/render/paths/path_wavefront.h"

namespace interflect::detail {

struct PixelStatistics {
    RgbD mean{0, 0, 0}, squares{0, 0, 0};
    RgbD emitted{0, 0, 0};
    PartStatistics direct, indirect;
    std::array<PartStatistics, 2> direct_halves, indirect_halves;  // of even and odd batches
    FirstHit first;
    std::uint32_t batches = 0;

    void add(const BatchOfPaths& b, double batch_size) {
        const RgbD from_emitters = b.emitted / batch_size, once = b.direct / batch_size,
                   more_often = b.indirect / batch_size, value = from_emitters + once + more_often;
        direct.add(once);
        indirect.add(more_often);
        direct_halves[batches % 2].add(once);
        indirect_halves[batches % 2].add(more_often);
        const double count = ++batches;
        const RgbD difference = value - mean;
        mean += difference / count;
        squares += difference * (value - mean);
        emitted += (from_emitters - emitted) / count;
        first.albedo += (b.first.albedo / batch_size - first.albedo) / count;
        first.normal += (b.first.normal / batch_size - first.normal) / count;
        first.position += (b.first.position / batch_size - first.position) / count;
        first.distance += (b.first.distance / batch_size - first.distance) / count;
        first.level += (b.first.level / batch_size - first.level) / count;
    }
    double reflected() const { return mean_channel(direct.mean + indirect.mean); }
    /// Variance of one batch.
    RgbD variance() const { return batches > 1 ? squares / (batches - 1.0) : RgbD(0, 0, 0); }
    RgbD squared_error() const { return batches > 1 ? variance() / static_cast<double>(batches) : RgbD(0, 0, 0); }
};

/// Returns Rendering::relative_error.
double relative_error(const std::vector<PixelStatistics>& pixels);

/// Returns the total per pixel.
/// @param target  Of the relative standard error.
std::vector<double> needed_batches(const std::vector<PixelStatistics>& pixels, const PictureOptions& options,
                                   double target);

}  // namespace interflect::detail
