#include "interflect/raycast/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/base/error.h"
#include "interflect/base/image_size.h"

namespace interflect {

namespace {

/// Sine of the angle between `up` and the direction of view below which the picture's upright is rounding error.
constexpr double smallest_up_sine = 1e-5;

using V3d = Imath::V3d;

template <class T>
std::string text(const Imath::Vec3<T>& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

[[noreturn]] void refuse(const View& view, const std::string& fault) {
    throw InputError(fmt::format("view '{}': {}", view.name, fault));
}

void require_usable(const View& view) {
    if (!is_finite(view.eye) || !is_finite(view.look_at) || !is_finite(view.up))
        refuse(view, fmt::format("eye {}, look-at {} and up {} must be finite", text(view.eye), text(view.look_at),
                                 text(view.up)));
    for (const V3d& x : {view.eye, view.look_at})
        if (std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) > farthest_coordinate)
            refuse(view, fmt::format("{} is farther than {:g} m from the origin, beyond which nothing is computed",
                                     text(x), farthest_coordinate));
    if (!(view.fov > 0 && view.fov < 180))
        refuse(view, fmt::format("the vertical field of view is {} degrees, expected more than 0 and less than 180",
                                 view.fov));
    if (view.eye == view.look_at)
        refuse(view, fmt::format("eye and look-at are the same point {}, so there is no direction to look in",
                                 text(view.eye)));
}

}  // namespace

Camera::Camera(const View& view, int width, int height, const V3d& origin) : eye_(view.eye - origin) {
    require_usable(view);
    if (width < 1 || height < 1 || width > most_image_pixels / height)
        throw InputError(
            fmt::format("a picture of {} x {} pixels: expected 1 x 1 or more, and at most {} pixels in all", width,
                        height, most_image_pixels));

    const V3d forward = (view.look_at - view.eye).normalized();
    const V3d right = forward.cross(V3d(view.up).normalized());
    if (!(right.length() > smallest_up_sine))
        refuse(view, fmt::format("up {} is zero or parallel to the direction from eye to look-at", text(view.up)));
    const V3d right_unit = right.normalized(), up = right_unit.cross(forward);

    const double half_height = std::tan(0.5 * view.fov * std::numbers::pi / 180);
    const double pixel = 2 * half_height / height;
    corner_ = V3f(forward - right_unit * (0.5 * pixel * width) + up * half_height);
    pixel_right_ = V3f(right_unit * pixel);
    pixel_down_ = V3f(up * -pixel);
}

}  // namespace interflect
