#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Replaces the irradiance of a solution after dimming. Scales the unreduced irradiance of each element by the same
/// factors.
inline void replace_irradiance(Solution& solution, std::vector<Rgb> dimmed) {
    for (std::size_t e = 0; e < solution.unreduced_irradiance.size(); ++e) {
        const Rgb& before = solution.irradiance[e];
        Rgb& unreduced = solution.unreduced_irradiance[e];
        for (int c = 0; c < 3; ++c)
            unreduced[c] = before[c] > 0 ? unreduced[c] * (dimmed[e][c] / before[c]) : dimmed[e][c];
    }
    solution.irradiance = std::move(dimmed);
}

}  // namespace interflect::detail
