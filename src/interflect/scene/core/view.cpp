#include "interflect/scene/core/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interflect/core.h"
#include "interflect/scene/core/core.h"
#include "interflect/scene/core/limits.h"

namespace interflect {

using namespace detail;

namespace {

using V3d = Imath::V3d;

/// Minimum sine of the angle between `up` and the direction of view.
constexpr double smallest_up_sine = 1e-5;

/// Minimum distance of look-at from the eye, relative to the eye's largest coordinate: rounding turns the view by at
/// most 1e-4 rad.
constexpr double smallest_relative_distance = 1e-12;

template <class T>
std::string text(const Imath::Vec3<T>& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

double largest_coordinate(const V3d& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); }

}  // namespace

std::string detail::view_fault(const View& view) {
    if (!is_finite(view.eye) || !is_finite(view.look_at) || !is_finite(view.up))
        return fmt::format("eye {}, look-at {} and up {} must be finite", text(view.eye), text(view.look_at),
                           text(view.up));
    for (const V3d& x : {view.eye, view.look_at})
        if (!is_within_reach(x))
            return fmt::format("{} is farther than {:g} m from the origin, the limit of the computation", text(x),
                               farthest_coordinate);
    if (!(view.extent >= 0 && view.extent <= farthest_coordinate))
        return fmt::format("its extent is {} m, expected from 0 to {:g}", view.extent, farthest_coordinate);
    if (!(view.fov > 0 && view.fov < 180))
        return fmt::format("the vertical field of view is {} degrees, expected between 0 and 180", view.fov);
    const V3d direction = view.look_at - view.eye;
    if (view.eye == view.look_at)
        return fmt::format("eye and look-at are the same point {}, which gives no direction of view", text(view.eye));
    if (direction.length() < smallest_relative_distance * largest_coordinate(view.eye))
        return fmt::format("look-at is only {:.3g} m from the eye {}: their direction is lost to rounding",
                           direction.length(), text(view.eye));
    if (!(direction.normalized().cross(V3d(view.up).normalized()).length() > smallest_up_sine))
        return fmt::format("up {} is zero or parallel to the direction from eye to look-at", text(view.up));
    return {};
}

const View& find_view(const Scene& scene, const std::string& name) {
    const auto view =
        std::find_if(scene.views.begin(), scene.views.end(), [&](const View& v) { return v.name == name; });
    if (view != scene.views.end()) return *view;
    std::string known;
    for (const View& v : scene.views) known += (known.empty() ? "" : ", ") + v.name;
    throw InputError(
        Fault{.text = "there is no view '" + name + "'; " + (known.empty() ? "it names none" : "it names: " + known),
              .object = name,
              .file = scene.name});
}

View overview(const Scene& scene) {
    constexpr float margin = 0.06f;  // fraction of the box, clear of walls
    constexpr float wide = 60;       // [degrees]
    const Imath::Box3f box = core_bounds(scene);
    View view;
    view.name = "overview";
    view.eye = scene.origin + Imath::V3d(box.min + box.size() * V3f(margin, margin, 0.7f));
    view.look_at = scene.origin + Imath::V3d(box.center());
    view.fov = wide;
    return view;
}

View cut_view(const Scene& scene, const Imath::V3d& point, const Imath::V3d& direction, float aspect) {
    constexpr double margin = 1.04, upright = 0.999;
    View view;
    const V3d forward = direction.normalized();
    view.up = std::abs(forward.z) > upright ? V3f(0, 1, 0) : V3f(0, 0, 1);
    const V3d right = forward.cross(V3d(view.up)).normalized(), up = right.cross(forward);

    const Imath::Box3f box = core_bounds(scene);
    const V3d half = V3d(box.size()) / 2, centre = scene.origin + V3d(box.center());
    const auto half_size = [&](const V3d& axis) {
        return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
    };
    view.eye = centre + forward * forward.dot(point - centre);
    view.look_at = view.eye + forward * std::max(1.0, half.length());
    view.extent = static_cast<float>(2 * margin * std::max(half_size(up), half_size(right) / aspect));
    return view;
}

}  // namespace interflect
