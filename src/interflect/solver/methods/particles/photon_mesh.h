#pragma once

#include <array>

#include "interflect/solver/methods/particles/path_batch.h"

namespace interflect::detail {

/// Whether the hits of an element's quarters indicate uneven light: Pearson's chi-squared test against equal numbers of
/// hits per area, for differences that can be seen (docs/method/method.md, Photon mesh).
/// @param areas  Of the quarters [m^2], > 0.
bool quarters_differ(const std::array<HitSum, 4>& hits, const std::array<float, 4>& areas);

}  // namespace interflect::detail
