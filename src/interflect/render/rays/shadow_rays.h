#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/rays/sample_batch.h"

namespace interflect::detail {

/// Tests the visibility of many points along rays. Panes transmit a share of the light.
class ShadowRays {
  public:
    /// @param patch     Patch that the ray must hit; none: the ray must be free up to `distance`.
    /// @param distance  Distance of the target, used without a patch [m].
    void add(const Ray& ray, PatchIndex patch, float distance);
    /// Traces all rays and removes them. Returns the transmittance of each; 0 if it is occluded.
    std::span<const Rgb> trace(const RayCaster& ray_caster, const Panes& panes, RayCounts& counts);

  private:
    struct Target {
        PatchIndex patch;
        float distance;
        /// Returns whether the ray reaches its target. An escaped ray reaches luminaires and skies, which have no
        /// patch.
        bool is_met(const Hit& hit) const { return hit.patch == patch || (patch == none && hit.distance > distance); }
    };
    void pass_panes(const RayCaster& ray_caster, const Panes& panes, RayCounts& counts);

    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<Target> targets_;
    std::vector<Rgb> transmittance_;
};

}  // namespace interflect::detail
