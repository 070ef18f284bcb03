#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/paths/sky_guide.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/reflections/known_light.h"

namespace interflect::detail {

/// Returns the known irradiance, with sampling adapted to the points (sample_seen_light()).
KnownLight known_light(const TracedScene& scene, const KnownIrradiance& known, std::span<const SurfacePoint> points,
                       std::uint64_t seed);

/// Light around the first points of a picture or of gauges, measured before paths are traced: the visibility of light
/// sources and, for final gathering and hybrid shading, the reflected light of a solution. Thread-safe after
/// construction.
class PreparedLight {
  public:
    /// Measures the light. Collective.
    /// @param plan   Plan without known light. Must outlive this, like `known`.
    /// @param known  Null for path tracing and for direct light alone.
    PreparedLight(const PathPlan& plan, const KnownIrradiance* known, const Monitor& monitor);
    PreparedLight(const PreparedLight&) = delete;
    PreparedLight& operator=(const PreparedLight&) = delete;

    /// Returns the plan with the measured light. It refers to this object.
    PathPlan plan() const;
    std::int64_t rays() const { return rays_; }

  private:
    const PathPlan& plan_;
    std::optional<LightSources> sources_;
    std::optional<KnownLight> light_;
    std::optional<IndirectField> field_;
    std::optional<SkyGuide> guide_;
    HybridLight hybrid_;
    std::int64_t rays_ = 0;
};

/// Shadow rays to each kind of light source at first points. Measured with 16 filtered samples per pixel:
///
///     rays                                                               1      2      4
///     squared error x time of gathering, relative: maze                  1      0.75   0.63
///                                                  office-graz           1      0.82   0.76
///                                                  office2               1      0.66   0.51
///     error of a pixel of hybrid shading, office-graz                    8.8%   6.5%   5.5%
///     time of hybrid shading, relative, office-graz                      1      1.1    1.4
inline constexpr std::uint32_t first_shadow_rays = 4;

}  // namespace interflect::detail
