#pragma once

#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

inline double mean_channel(const RgbD& c) { return channel_sum(c) / 3; }

/// Running mean over groups of paths.
struct GroupMean {
    RgbD mean{0, 0, 0};
    std::uint32_t groups = 0;

    void add(const RgbD& value) { mean += (value - mean) / static_cast<double>(++groups); }
};

}  // namespace interflect::detail
