#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/render/lights/known_light.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/render/lights/luminaire_choice.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "interflect/render/lights/virtual_lights.h"
#include "interflect/render/paths/path_wavefront.h"
#include "interflect/render/smooth/smooth_normals.h"

namespace interflect::detail {

/// Irradiance per element, at which paths end.
struct KnownIrradiance {
    const ElementForest& forest;
    std::span<const Rgb> irradiance;
    bool is_interpolated = false;  ///< Hybrid shading: an IndirectField replaces gathered directions.
};

/// Paths that a PathWavefront traces together, which amortises the cost of a call.
constexpr std::size_t paths_per_tile = 2048;

/// Immutable, thread-safe.
class TracedScene {
  public:
    /// @param known  Of the scene; may be null. Arguments must outlive this object.
    TracedScene(const Scene& scene, const RayCaster& ray_caster, const KnownIrradiance* known);
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    /// Without known light. @param start, options  Must outlive the result.
    PathScene paths(const PathStart& start, const PathOptions& options, std::size_t batch_size) const;

    /// Returns the known irradiance, with sampling adapted to the points (sample_seen_light()).
    KnownLight known_light(const PathScene& paths, std::span<const SurfacePoint> points) const;

    /// Refers to this object.
    VirtualLights virtual_lights(const PathOptions& options) const;

    /// Paths per batch, a power of two, for at least this number of batches.
    static std::size_t batch_size(int samples, int batches);

  private:
    const Scene& scene_;
    const RayCaster& ray_caster_;
    std::vector<PatchGeometry> geometry_;
    LightTree lights_;
    LuminaireChoice luminaires_;
    Skies skies_;
    Panes panes_;
    UnoccludedLight unoccluded_;
    bool has_mirrors_;
    std::optional<KnownIrradiance> known_;
    std::optional<SmoothNormals> smooth_normals_;  // of scenes with normals
};

/// Relative standard error in hybrid shading above which a pixel or texel gets more samples.
constexpr double hybrid_target = 0.06;

/// First vertices: about one per pixel of the camera, or the gauges.
/// @param stop  If due within this process, some points are missing.
std::vector<SurfacePoint> first_points(const PathScene& scene, const StopRequest& stop);

struct SampledIrradiance {
    Rgb irradiance;           ///< [as H]
    float squared_error = 0;  ///< Estimated, of the mean of the channels.
};
struct GaugeLight {
    SampledIrradiance direct;
    std::array<SampledIrradiance, 2> halves;  ///< `direct` from every other batch, and from the rest.
    Rgb indirect;                             ///< Interpolated [as H].

    Rgb irradiance() const { return direct.irradiance + indirect; }
};

/// Irradiance of gauges by hybrid shading, with options.samples paths for each. Without skies and extended sources that
/// only chance finds, two batches of them if the estimated relative error is below options.until or, without it,
/// hybrid_target.
/// @param scene  With interpolated KnownIrradiance.
/// @return       Per gauge, in rank 0 only; the same bits for any number of threads and ranks. Collective.
/// @throws Stopped, in all ranks.
std::vector<GaugeLight> hybrid_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                          const PathOptions& options, const Monitor& monitor);
/// The direct part.
std::vector<SampledIrradiance> direct_irradiance(const TracedScene& scene, std::span<const Gauge> gauges,
                                                 const PathOptions& options, const Monitor& monitor);

}  // namespace interflect::detail
