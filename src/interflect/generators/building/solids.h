#pragma once

#include <optional>

#include "interflect/scene.h"

namespace interflect::inline detail::building {

/// What is kept between any two solids, and between solids and walls [m]. Nothing touches, so no two faces coincide;
/// and it is more than RayCaster::ray_offset() in the largest scenes made here (2.5 mm at 330 m from the origin), so
/// that a ray from the underside of a thing does not start below what the thing stands on.
inline constexpr float gap = 0.004f;

/// A place to stand: an origin on a floor, and a turn about the vertical.
class Placement {
  public:
    Placement() = default;
    /// @param quarter_turns  Counter-clockwise seen from above; exact.
    static Placement quarter_turned(const V3f& origin, int quarter_turns);
    static Placement turned(const V3f& origin, float radians);

    V3f point(const V3f& local) const {
        return origin_ + V3f(cosine_ * local.x - sine_ * local.y, sine_ * local.x + cosine_ * local.y, local.z);
    }
    /// A place that is given relative to this one.
    Placement at(const V3f& local, float radians = 0) const;

  private:
    V3f origin_{0, 0, 0};
    float cosine_ = 1, sine_ = 0;
};

/// A place in a scene where solids are added, closed ones, each of six one-sided faces that look outwards, with eight
/// vertices of its own.
class Solids {
  public:
    Solids(Scene& scene, const Placement& placement, std::uint32_t object)
        : scene_(&scene), placement_(placement), object_(object) {}

    /// The same, for parts that are placed relative to this placement.
    Solids at(const V3f& local, float radians = 0) const {
        return Solids(*scene_, placement_.at(local, radians), object_);
    }

    /// @param low, high  Opposite corners, low < high in each coordinate.
    /// @param underside  Material of the lower face, where it is another.
    void box(const V3f& low, const V3f& high, std::uint32_t material,
             std::optional<std::uint32_t> underside = std::nullopt) const;

    /// A box whose top is `top_scale` times as large as its bottom, about the same vertical axis; top_scale > 0.
    void tapered_box(const V3f& low, const V3f& high, float top_scale, std::uint32_t material) const;

  private:
    Scene* scene_;
    Placement placement_;
    std::uint32_t object_;
};

}  // namespace interflect::inline detail::building
