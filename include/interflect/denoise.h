#pragma once

#include "interflect/path_tracer.h"

namespace interflect {

/// Removes noise from a picture of gather() or trace_paths(): each pixel becomes a weighted mean of its surroundings.
/// Direct and indirect light are filtered separately, as irradiance, which keeps reflectances, textures and emitters
/// sharp. A neighbour counts if it lies in the pixel's tangent plane and its light differs by no more than noise
/// explains, which preserves shadow borders (non-local means, Buades et al. 2005, with estimated variance as in
/// Rousselle et al. 2012). Weights of one half of the samples come from the other half, which preserves the mean
/// despite bright outliers. The result is biased where the light varies by less than its noise.
/// @return  The picture, in the same unit.
Image denoise(const PictureLayers& layers);

}  // namespace interflect
