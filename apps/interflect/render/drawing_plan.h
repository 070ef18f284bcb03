#pragma once

#include <optional>

#include "apps/interflect/drawing/drawing_time.h"
#include "apps/interflect/render/render_arguments.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::command {

/// How the picture is drawn. A time limit may require a preview, or a faster shading with fewer samples.
struct DrawingPlan {
    PictureOptions picture;  ///< Options of interflect::render().
    /// Predicted duration. Empty without --time, and if the run ended before a prediction.
    std::optional<DrawingTime> predicted{};

    /// Above 1, a preview is drawn: PreviewOptions::reduction.
    double reduction() const { return predicted ? predicted->reduction : 1; }
};

struct PlannedSolution {
    Solution solution;
    DrawingPlan plan;
};

/// Solves within the part of --time that drawing does not need. Plans the drawing within the remaining time, and warns
/// if the picture is simplified or will be late.
/// @param solve_options  Their time limit is replaced.
PlannedSolution solve_in_time(const Scene& scene, const RayCaster& ray_caster, const View& view,
                              SolveOptions solve_options, const RenderArguments& options);

}  // namespace interflect::command
