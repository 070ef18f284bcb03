#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Rays through the square pixels of an image: from the eye, where `fov` spans the image's height, or, for views with
/// an `extent`, parallel rays from the plane through the eye.
class Camera {
  public:
    /// Rejects all views and sizes that render() rejects, which allows a check before a solve.
    /// @param origin  Scene::origin; rays are relative to it, views are in world coordinates.
    /// @throws InputError, naming the view, for a view_fault() (scene/view.h) or pixels below 2^-22 rad, with parallel
    ///         rays below the resolution of the eye's coordinates. InputError for a width or height < 1 or more than
    ///         most_image_pixels pixels (base/image_size.h).
    Camera(const View& view, int width, int height, const Imath::V3d& origin);

    /// Returns the ray through a point of the image plane.
    /// @param x, y  From the top left corner [pixels]; the centre of the first pixel is (0.5, 0.5).
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

}  // namespace interflect::detail
