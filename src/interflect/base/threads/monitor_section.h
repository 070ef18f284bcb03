#pragma once

#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

/// Maps the progress of a section of the work to fractions in [begin, end] of the whole.
/// @param whole        Must outlive the result.
/// @param rays_before  Rays of earlier sections.
inline Monitor monitor_section(const Monitor& whole, double begin, double end, std::int64_t rays_before = 0) {
    Monitor monitor = whole;
    if (whole.on_progress)
        monitor.on_progress = [&whole, begin, end, rays_before](Progress progress) {
            progress.fraction = begin + (end - begin) * progress.fraction;
            progress.rays += rays_before;
            whole.on_progress(progress);
        };
    return monitor;
}

}  // namespace interflect::detail
