#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Rays through square pixels: perspective, or parallel for a view with `extent`.
class Camera {
  public:
    /// @param origin  Scene::origin; rays are relative to it.
    /// @throws InputError for a view_fault(), pixels below 2^-22 rad or the resolution of coordinates, and sizes
    ///     outside 1 ... max_image_pixels.
    Camera(const View& view, int width, int height, const Imath::V3d& origin);

    /// @param x, y  From the top left corner [pixels].
    Ray ray(float x, float y) const {
        const V3f to_pixel = corner_ + x * pixel_right_ + y * pixel_down_;
        return is_orthographic_ ? Ray{eye_ + to_pixel, forward_} : Ray{eye_, to_pixel.normalized()};
    }

  private:
    bool is_orthographic_;
    V3f eye_;                       // relative to the scene's origin [m]
    V3f forward_;                   // unit length
    V3f corner_;                    // from the eye to the top left corner, at distance 1 (orthographic: 0)
    V3f pixel_right_, pixel_down_;  // edges of a pixel in the plane of the corner
};

}  // namespace interflect::detail
