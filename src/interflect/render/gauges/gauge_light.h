#pragma once

#include <array>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/render.h"
#include "interflect/render/prepared/prepared_light.h"
#include "interflect/render/rays/gauge.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

struct SampledIrradiance {
    Rgb irradiance;           ///< [as H]
    float squared_error = 0;  ///< Estimated squared error of the mean of the channels.
};
struct GaugeLight {
    SampledIrradiance direct;  ///< With the indirect light that a gauge gathers itself, whose noise is filtered too.
    std::array<SampledIrradiance, 2> halves;  ///< `direct` from the halves of the samples (SampleBatch).
    Rgb indirect;  ///< Interpolated between records, or gathered if no record is near [as H].

    Rgb irradiance() const { return direct.irradiance + indirect; }
};

/// Computes the irradiance of gauges by hybrid shading, with at most options.samples paths for each gauge, an even
/// number. A gauge first gets an eighth of them. Its neighbours in the list determine the number of further samples,
/// which reduce the estimated error of their direct light, relative to all their light, to options.until or, if that is
/// 0, hybrid_target. Direct light is unbiased, because the number of samples of a gauge does not depend on its own
/// samples.
/// @param known  Irradiance with is_interpolated set.
/// @return       Per gauge, in rank 0 only; the same bits for any number of threads and ranks. Collective.
/// @throws Stopped, in all ranks.
std::vector<GaugeLight> hybrid_irradiance(const TracedScene& scene, const KnownIrradiance& known,
                                          std::span<const Gauge> gauges, const PictureOptions& options,
                                          const Monitor& monitor);
/// Computes the direct part of hybrid_irradiance() alone.
std::vector<SampledIrradiance> direct_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                                 const PictureOptions& options, const Monitor& monitor);

}  // namespace interflect::detail
