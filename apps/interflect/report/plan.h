#pragma once

#include <ImathVec.h>

#include "interflect/image.h"
#include "interflect/measure.h"
#include "interflect/plots.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/solve.h"

namespace interflect::command {

/// Plan of a floor, and of the illuminance on a plane above it. x points right, y up.
struct ReportPlan {
    Imath::V2d low{0, 0}, high{0, 0};  ///< World corners of the pictures [m].
    Imath::V2d floor_size{0, 0};       ///< Size of the floor [m]; excludes the margin.
    Image outlines;                    ///< Outlines of objects, black on white.
    Image illuminance;                 ///< The outlines over false colours with isolines; white inside furniture.
    ColourScale scale;                 ///< Scale of the false colours [lx].
};

/// Draws a plan with a progress bar; stop_flag() ends it early. @param height  World z of the plane [m].
/// @param options  Options of the measuring points.
ReportPlan draw_plan(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const PlanarArea& floor,
                     double height, const MeasuringOptions& options);

}  // namespace interflect::command
