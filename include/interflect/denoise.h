#pragma once

#include "interflect/path_tracer.h"

namespace interflect {

/// Removes noise from a picture of gather() or trace_paths(): each pixel becomes a weighted mean over the pixels around
/// it. Direct and indirect light are filtered each by itself, as irradiance: reflectances, textures too, and what emits
/// stay as sharp as they are. A neighbour counts if it lies in the pixel's tangent plane, and if its light differs by
/// no more than noise explains (non-local means, Buades et al. 2005, by the estimated variance as Rousselle et al.
/// 2012), so that shadows keep their borders. The weights of one half of the samples come from the other half, so that
/// bright outliers are neither kept nor left out: the mean stays. The result is biased where the light varies by less
/// than its noise.
/// @return  The picture, in the same unit.
Image denoise(const PictureLayers& layers);

}  // namespace interflect
