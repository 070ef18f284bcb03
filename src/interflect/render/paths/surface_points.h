#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/threads/stop_request.h"
#include "interflect/core.h"
#include "interflect/render/rays/path_plan.h"

namespace interflect::detail {

/// Point of a visible surface or gauge, at which paths start.
struct SurfacePoint {
    V3f position;  ///< Start of its rays, relative to the scene's origin [m].
    V3f normal;    ///< For shading, unit length.
    PatchIndex patch{};
    float spacing = 0;  ///< Distance to the nearest other points, which is the size of a pixel or texel there [m].
};

/// Returns the first points of paths: about one per pixel of the camera, more with mirrors and panes, or one per gauge.
/// @param stop  If a stop is due within this process, some points are missing.
std::vector<SurfacePoint> first_points(const PathPlan& plan, const StopRequest& stop);

}  // namespace interflect::detail
