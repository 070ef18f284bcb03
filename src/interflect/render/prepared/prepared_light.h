#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/elements/forest.h"
#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/paths/sky_guide.h"
#include "interflect/render/rays/path_plan.h"
#include "interflect/render/reflections/known_light.h"

namespace interflect::detail {

/// Irradiance per element, at which paths end.
struct KnownIrradiance {
    const ElementForest& forest;
    std::span<const Rgb> irradiance;
    bool is_interpolated = false;  ///< Hybrid shading: an IndirectField replaces gathered directions.
};

/// Returns the known irradiance, with sampling adapted to the points (sample_seen_light()).
KnownLight known_light(const TracedScene& scene, const KnownIrradiance& known, std::span<const SurfacePoint> points,
                       std::uint64_t seed);

/// Light around the first points of a picture or of gauges, measured before paths are traced: the visibility of light
/// sources; for final gathering and hybrid shading also the reflected light of a solution.
/// Thread-safe after construction.
class PreparedLight {
  public:
    /// @param plan     Without known light; must outlive this, as does `known`.
    /// @param known    Null for path tracing and for direct light alone.
    /// @param monitor  Collective.
    PreparedLight(const PathPlan& plan, const KnownIrradiance* known, const Monitor& monitor);
    PreparedLight(const PreparedLight&) = delete;
    PreparedLight& operator=(const PreparedLight&) = delete;

    /// The plan with that light. Refers to this object.
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

/// Shadow rays to each kind of light source at first points. Squared error times time of gathering in maze, office-graz
/// and office2 (16 samples, filtered; one ray: 1): two rays 0.75, 0.82, 0.66; four rays 0.63, 0.76, 0.51. Error of
/// filtered pixels of hybrid shading in office-graz, 16 samples: one ray 8.8%, two 6.5%, four 5.5% in 1.1 and 1.4 times
/// the time of one.
inline constexpr std::uint32_t first_shadow_rays = 4;

}  // namespace interflect::detail
