#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// What lies behind panes, through which rays go straight on: thin glass, and faces with holes
/// (Material::transmittance). Refers to the scene and its ray caster. Immutable, shared by all threads.
class Panes {
  public:
    Panes(const Scene& scene, const RayCaster& ray_caster);

    bool empty() const { return !any_; }
    /// Where a ray has hit: 0 where it escapes, and for what is no pane.
    Rgb transmittance(const Ray& ray, const Hit& hit) const;

    /// The rest of a ray that has hit a pane: it starts behind that.
    Ray behind(const Ray& ray, const Hit& hit) const;

    /// What a ray meets behind its first hit.
    struct HitBehind {
        std::uint32_t ray;  ///< Index.
        Rgb transmittance;  ///< Of all panes before it.
        Hit hit;            ///< Distance from where the ray starts; escaped rays have their hits too.
    };
    /// Finds all that rays meet behind panes, pane by pane, in order of the rays.
    /// @param hits  Of the rays, first hits. @param behind  Receives them.
    void trace(std::span<const Ray> rays, std::span<const Hit> hits, std::vector<HitBehind>& behind) const;

    /// Panes that light goes through at the most, one behind the other.
    static constexpr int most_in_a_row = 32;

  private:
    const Scene& scene_;
    const RayCaster& ray_caster_;
    bool any_;
};

}  // namespace interflect::inline detail
