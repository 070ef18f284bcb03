#pragma once

#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

inline double mean_channel(const RgbD& c) { return channel_sum(c) / 3; }

/// Statistics over batches of paths (Welford 1962).
struct PartStatistics {
    RgbD mean{0, 0, 0};
    double squares = 0;  // squared deviations of mean_channel()
    std::uint32_t batches = 0;

    void add(const RgbD& value) {
        const RgbD difference = value - mean;
        mean += difference / static_cast<double>(++batches);
        squares += mean_channel(difference) * mean_channel(value - mean);
    }
    double squared_error() const { return batches > 1 ? squares / (batches - 1.0) / batches : 0; }
};

}  // namespace interflect::detail
