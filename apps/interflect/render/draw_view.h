#pragma once

#include "apps/interflect/render/drawing_plan.h"
#include "apps/interflect/render/pictures.h"
#include "apps/interflect/render/render_arguments.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

/// Draws the light by tracing paths. With --progressive, writes previews meanwhile.
/// @param solution  Null for shading without a solution.
Picture draw_paths(const Scene& scene, const Solution* solution, const RayCaster& ray_caster, const View& view,
                   const PictureOptions& picture_options, const RenderArguments& options);

/// Draws the light or a quantity of a solution. If a signal stops path tracing before every pixel has light, draws a
/// preview instead. It cannot replace layers and error images, which are then incomplete.
Picture draw_solution(const SolvedScene& solved, const RayCaster& ray_caster, const View& view, const DrawingPlan& plan,
                      const RenderArguments& options);

}  // namespace interflect::command
