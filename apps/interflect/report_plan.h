#pragma once

#include <ImathVec.h>

#include "interflect/image.h"
#include "interflect/image/false_colour.h"
#include "interflect/measuring_grid.h"
#include "interflect/path_tracer.h"
#include "interflect/ray_caster.h"
#include "interflect/solve.h"

namespace interflect::command {

/// A plan of the floor and what stands on it, and of the illuminance on a plane over it. x goes right, y up.
struct ReportPlan {
    Imath::V2d low{0, 0}, high{0, 0};  ///< Corners of the pictures in the world [m].
    Image outlines;                    ///< Outlines of things, black on white.
    Image illuminance;                 ///< The same over false colours with isolines.
    ColourScale scale;                 ///< Of these [lx].
};

/// Draws it, with a progress bar; Ctrl-C ends it early.
/// @param floor    What the plan shows. @param height  Of the plane, z in the world [m].
/// @param options  Of each measuring point; width and height mean nothing.
ReportPlan draw_plan(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const PlanarArea& floor,
                     double height, const PathOptions& options);

}  // namespace interflect::command
