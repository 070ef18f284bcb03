#pragma once

#include <array>

#include "interflect/solver/methods/particles/path_batch.h"

namespace interflect::detail {

/// Returns whether the hits of an element's quarters indicate visibly uneven light, by Pearson's chi-squared test
/// against equal numbers of hits per area (docs/method/method.md, Photon mesh).
/// @param areas  Areas of the quarters [m^2], > 0.
bool quarters_differ(const std::array<HitSum, 4>& hits, const std::array<float, 4>& areas);

}  // namespace interflect::detail
