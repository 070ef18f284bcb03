#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Continues rays through thin glass and perforated faces (Material::transmittance). Immutable, thread-safe. Arguments
/// must outlive it.
class Panes {
  public:
    Panes(const Scene& scene, const RayCaster& ray_caster);

    bool empty() const { return !any_; }
    /// Returns the transmittance of the surface that was hit; 0 for escaped rays.
    Rgb transmittance(const Ray& ray, const Hit& hit) const;

    /// Returns the ray that continues behind the pane that was hit.
    Ray behind(const Ray& ray, const Hit& hit) const;

    struct HitBehind {
        std::uint32_t ray;
        Rgb transmittance;  ///< Product over panes before the hit.
        Hit hit;            ///< Distance from the ray's origin. Includes escaped rays.
    };
    /// Finds all hits behind panes, sorted by ray, then depth.
    void trace(std::span<const Ray> rays, std::span<const Hit> hits, std::vector<HitBehind>& behind) const;

    static constexpr int max_consecutive_panes = 32;

  private:
    const Scene& scene_;
    const RayCaster& ray_caster_;
    bool any_;
};

}  // namespace interflect::detail
