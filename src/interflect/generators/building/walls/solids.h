#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::detail::building {

/// Distance between solids and to walls [m]. Exceeds RayCaster::ray_offset() in the largest generated scenes (2.5 mm):
/// rays from undersides start above the surface below.
inline constexpr float gap = 0.004f;

class Placement {
  public:
    Placement() = default;
    /// @param quarter_turns  Counter-clockwise from above; exact.
    static Placement quarter_turned(const V3f& origin, int quarter_turns);
    static Placement turned(const V3f& origin, float radians);

    V3f point(const V3f& local) const {
        return origin_ + V3f(cosine_ * local.x - sine_ * local.y, sine_ * local.x + cosine_ * local.y, local.z);
    }
    Placement at(const V3f& local, float radians = 0) const;

  private:
    V3f origin_{0, 0, 0};
    float cosine_ = 1, sine_ = 0;
};

/// Adds solids of six one-sided outward faces with their own vertices.
class Solids {
  public:
    Solids(Scene& scene, const Placement& placement, std::uint32_t object)
        : scene_(&scene), placement_(placement), object_(object) {}

    Solids at(const V3f& local, float radians = 0) const {
        return Solids(*scene_, placement_.at(local, radians), object_);
    }

    /// @param underside  Material of the lower face, if different.
    void box(const V3f& low, const V3f& high, std::uint32_t material,
             std::optional<std::uint32_t> underside = std::nullopt) const;

    /// @param top_scale  Scale of the top about the vertical axis, > 0.
    void tapered_box(const V3f& low, const V3f& high, float top_scale, std::uint32_t material) const;

  private:
    Scene* scene_;
    Placement placement_;
    std::uint32_t object_;
};

}  // namespace interflect::detail::building
