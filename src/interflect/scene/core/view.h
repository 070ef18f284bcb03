#pragma once

#include <string>

#include "interflect/scene.h"

namespace interflect::detail {

/// Describes a fault; "" if valid. Eye and look-at must be within farthest_coordinate and define a direction; `up` must
/// not be 0 or along it; fov in (0, 180); extent in [0, farthest_coordinate].
std::string view_fault(const View& view);

/// @throws InputError listing the available views.
const View& find_view(const Scene& scene, const std::string& name);

/// Returns the default view from inside an upper corner of core_bounds() to its middle.
View overview(const Scene& scene);

/// Returns an orthographic view of core_bounds() beyond a plane, with a margin; z up, or y in views along z.
/// @param point  On the plane, in world coordinates [m].
/// @param direction  Normal to the plane; not 0.
/// @param aspect  Width over height.
View cut_view(const Scene& scene, const Imath::V3d& point, const Imath::V3d& direction, float aspect);

}  // namespace interflect::detail
