#include "interflect/raycast/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "interflect/core.h"
#include "interflect/image.h"
#include "interflect/scene/core/view.h"

namespace interflect::detail {

namespace {

using V3d = Imath::V3d;

/// Smallest pixel [rad], or, in parallel views, relative to the largest coordinate of the eye. It is four times the
/// rounding 2^-24 of a float.
constexpr double smallest_pixel = 0x1p-22;

double largest_coordinate(const V3d& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); }

}  // namespace

Camera::Camera(const View& view, int width, int height, const V3d& origin)
    : is_orthographic_(view.extent > 0), eye_(view.eye - origin) {
    if (const std::string fault = view_fault(view); !fault.empty())
        throw InputError(fmt::format("view '{}': {}", view.name, fault));
    if (width < 1 || height < 1 || width > max_image_pixels / height)
        throw InputError(
            fmt::format("a picture of {} x {} pixels: expected 1 x 1 or more, and at most {} pixels in all", width,
                        height, max_image_pixels));

    const V3d forward = (view.look_at - view.eye).normalized();
    const V3d right = forward.cross(V3d(view.up).normalized()).normalized(), up = right.cross(forward);
    const double half_height = is_orthographic_ ? 0.5 * view.extent : std::tan(0.5 * view.fov * std::numbers::pi / 180);
    const double pixel = 2 * half_height / height;
    if (is_orthographic_ && pixel < smallest_pixel * largest_coordinate(view.eye - origin))
        throw InputError(
            fmt::format("view '{}': pixels of {:.3g} m are finer than coordinates there", view.name, pixel));
    if (!is_orthographic_ && pixel < smallest_pixel)
        throw InputError(fmt::format(
            "view '{}': {} degrees over {} pixels are finer than the directions of rays: expected a field of "
            "view of {:.3g} degrees or more",
            view.name, view.fov, height, smallest_pixel * height * 180 / std::numbers::pi));
    forward_ = V3f(forward);
    corner_ = V3f((is_orthographic_ ? V3d(0) : forward) - right * (0.5 * pixel * width) + up * half_height);
    pixel_right_ = V3f(right * pixel);
    pixel_down_ = V3f(up * -pixel);
}

}  // namespace interflect::detail

namespace interflect {

void require_picture(const View& view, int width, int height, const Imath::V3d& origin) {
    detail::Camera(view, width, height, origin);
}

}  // namespace interflect
