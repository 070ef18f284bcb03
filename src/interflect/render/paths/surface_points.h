#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/threads/stop_request.h"
#include "interflect/core.h"
#include "interflect/render/rays/path_plan.h"

namespace interflect::detail {

/// Place that needs light.
struct SurfacePoint {
    V3f position;  ///< Start of its rays, relative to the scene's origin [m].
    V3f normal;    ///< For shading, unit length.
    PatchIndex patch{};
    float spacing = 0;  ///< Distance to the nearest such points: size of a pixel or texel [m].
};

/// First points: about one per pixel of the camera, more with mirrors and panes, or the gauges.
/// @param stop  If due within this process, some points are missing.
std::vector<SurfacePoint> first_points(const PathPlan& plan, const StopRequest& stop);

}  // namespace interflect::detail
