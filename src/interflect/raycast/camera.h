#pragma once

#include "interflect/ray_caster.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Generates rays through square pixels: from the eye, with `fov` over the image's height, or parallel if the view has
/// an `extent`.
class Camera {
  public:
    /// Rejects the views and sizes that render() rejects, for checks before a solve.
    /// @param origin  Scene::origin: rays are relative to it, views are in world coordinates.
    /// @throws InputError for a view_fault() (scene/view.h), for pixels below 2^-22 rad or the resolution of
    ///     coordinates, and for sizes outside 1 ... most_image_pixels.
    Camera(const View& view, int width, int height, const Imath::V3d& origin);

    /// @param x, y  From the top left corner [pixels]; the first pixel's centre is (0.5, 0.5).
    Ray ray(float x, float y) const {
        const V3f place = corner_ + x * pixel_right_ + y * pixel_down_;
        return is_orthographic_ ? Ray{eye_ + place, forward_} : Ray{eye_, place.normalized()};
    }

  private:
    bool is_orthographic_;
    V3f eye_;      // relative to the scene's origin [m]
    V3f forward_;  // unit length
    V3f corner_;   // from the eye to the image plane's top left corner, at distance 1, or 0 if orthographic
    V3f pixel_right_, pixel_down_;  // one pixel on that plane
};

}  // namespace interflect::detail
