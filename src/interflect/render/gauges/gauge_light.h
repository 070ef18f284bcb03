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
    float squared_error = 0;  ///< Estimated, of the mean of the channels.
};
struct GaugeLight {
    SampledIrradiance direct;
    std::array<SampledIrradiance, 2> halves;  ///< `direct` from the halves of the samples (SampleBatch).
    Rgb indirect;                             ///< Interpolated; gathered where no record is near [as H].

    Rgb irradiance() const { return direct.irradiance + indirect; }
};

/// Irradiance of gauges by hybrid shading, with options.samples paths for each, an even number. A quarter suffices
/// where the direct light of the neighbours in the list has an estimated error, relative to all reflected light, below
/// options.until or, without it, hybrid_target. Direct light is unbiased: the number of samples of a gauge does not
/// depend on these samples.
/// @param known  Interpolated.
/// @return       Per gauge, in rank 0 only; the same bits for any number of threads and ranks. Collective.
/// @throws Stopped, in all ranks.
std::vector<GaugeLight> hybrid_irradiance(const TracedScene& scene, const KnownIrradiance& known,
                                          std::span<const Gauge> gauges, const PictureOptions& options,
                                          const Monitor& monitor);
/// The direct part.
std::vector<SampledIrradiance> direct_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                                 const PictureOptions& options, const Monitor& monitor);

}  // namespace interflect::detail
