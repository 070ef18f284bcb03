#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::inline detail {

/// Makes camera rays through the square pixels of an image: of a pinhole camera at the eye of a View, whose `fov` is
/// the angle from the top edge of the image to its bottom edge, or parallel ones from the plane through the eye, where
/// the view has an `extent`.
class Camera {
  public:
    /// Made before a solve, it finds all that render() could object to in a view and a size.
    /// @param origin  Scene::origin: its rays are relative to it, which is where views stop being in world coordinates.
    /// @throws InputError, naming the view, where it has a view_fault() (scene/view.h), or where its pixels are finer
    ///         than the directions of rays, 2^-22 rad, or with parallel rays than the eye's coordinates. InputError
    ///         where width or height is < 1 or there are more than most_image_pixels (base/image_size.h).
    Camera(const View& view, int width, int height, const Imath::V3d& origin);

    /// The ray through a point of the image plane.
    /// @param x, y  In pixels from the image's top left corner; the centre of the first pixel is (0.5, 0.5).
    Ray ray(float x, float y) const {
        const V3f place = corner_ + x * pixel_right_ + y * pixel_down_;
        return is_orthographic_ ? Ray{eye_ + place, forward_} : Ray{eye_, place.normalized()};
    }

  private:
    bool is_orthographic_;
    V3f eye_;                       // relative to the scene's origin [m]
    V3f forward_;                   // of unit length
    V3f corner_;                    // from the eye to the top left corner of the image plane: at distance 1, or at 0
    V3f pixel_right_, pixel_down_;  // one pixel's steps on that plane
};

}  // namespace interflect::inline detail
