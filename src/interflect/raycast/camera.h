#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Generates rays through the square pixels of an image. A pinhole view emits them from its eye; `fov` is the angle
/// between the top and bottom edges. A view with an `extent` emits parallel rays from the plane through the eye.
class Camera {
  public:
    /// Rejects every view and size that render() would reject, so it can check them before a solve.
    /// @param origin  Scene::origin; rays are relative to it, while views are in world coordinates.
    /// @throws InputError, naming the view, if it has a view_fault() (scene/view.h) or its pixels are too fine: below
    ///         2^-22 rad, or for parallel rays below the resolution of the eye's coordinates. InputError if width or
    ///         height is < 1 or there are more than most_image_pixels pixels (base/image_size.h).
    Camera(const View& view, int width, int height, const Imath::V3d& origin);

    /// Returns the ray through a point of the image plane.
    /// @param x, y  Distance from the top left corner [pixels]; the centre of the first pixel is (0.5, 0.5).
    Ray ray(float x, float y) const {
        const V3f place = corner_ + x * pixel_right_ + y * pixel_down_;
        return is_orthographic_ ? Ray{eye_ + place, forward_} : Ray{eye_, place.normalized()};
    }

  private:
    bool is_orthographic_;
    V3f eye_;                       // relative to the scene's origin [m]
    V3f forward_;                   // unit length
    V3f corner_;                    // from the eye to the top left corner of the image plane, at distance 1 or 0
    V3f pixel_right_, pixel_down_;  // steps of one pixel on that plane
};

}  // namespace interflect::inline detail
