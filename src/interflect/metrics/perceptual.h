#pragma once

#include "interflect/image.h"

namespace interflect::detail {

/// Computes the first model of Rushmeier et al. 1995 (docs/metrics.md) from luminances, clamped to >= 0. A black
/// reference gives 0 for a black image, otherwise infinity.
/// @param field_of_view  Full vertical angle [degrees], in (0, 180).
/// @throws InputError for different sizes, no pixels, or a field of view out of range. Pixels must be finite.
/// O(N log N) for sides with small prime factors, at worst O(N (width + height)).
double perceptual_distance(const Image& image, const Image& reference, double field_of_view);

}  // namespace interflect::detail
