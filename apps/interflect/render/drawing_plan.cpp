#include "apps/interflect/render/drawing_plan.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "apps/interflect/console/progress.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/render/previews.h"
#include "apps/interflect/solving/run_solve.h"

namespace interflect::command {

namespace {

constexpr double shortest_time = 1e-3;  // [s]; replaces times that are 0 or negative

/// Returns the time limit of solving [s] that leaves enough time for drawing. The clock of the solver stands still
/// while drawing is planned, so the limit is the time solved so far plus the rest of the remaining time.
double time_limit_of_solving(const Solution& so_far, const DrawingPlan& plan, const RenderArguments& options) {
    const double left = options.seconds_left();
    const double spent = so_far.iterations.empty() ? 0 : so_far.iterations.back().seconds;
    const bool is_preview = plan.reduction() > 1;
    const bool takes_more_samples = traces_paths(plan.picture.shading) && !is_preview;
    return spent + std::max(shortest_time, left - reserved_for(*plan.predicted, takes_more_samples, left));
}

void warn_of_reduction(double reduction) {
    spdlog::warn(
        "--time is too short for all pixels: light is traced for one in {} x {}, so small shadows are "
        "blurred; a smaller --size takes less time",
        reduction, reduction);
}

/// @param left  Time that --time leaves for drawing [s].
void warn_of_late_picture(double predicted, double left) {
    spdlog::warn("drawing takes about {}, but --time leaves {}: the picture will be late", duration(predicted),
                 duration(std::max(0.0, left)));
}

/// @param left  Time that --time leaves for drawing [s].
void warn_of_smooth_shading(double predicted, double left) {
    spdlog::warn(
        "per-pixel shading takes about {}, but --time leaves {}: the light is drawn as with --shading "
        "smooth; a smaller --size takes less time",
        duration(predicted), duration(std::max(0.0, left)));
}

/// Predicts the time of drawing from smaller pictures. If --time leaves less, hybrid shading becomes a preview, whose
/// reduction is part of the prediction. Other shadings by paths become smooth shading with few samples.
DrawingPlan plan_drawing(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const View& view,
                         const RenderArguments& options) {
    DrawingPlan plan{options.picture};
    if (traces_paths(plan.picture.shading)) {
        // Layers and error images need at least the fewest samples of all pixels, however long these take
        const bool needs_all_pixels = options.path.has_path_outputs();
        const double limit =
            needs_all_pixels ? std::numeric_limits<double>::infinity() : largest_drawing_share * options.seconds_left();
        plan.predicted =
            predict_time_of_paths(scene, solution, ray_caster, view, plan.picture, options.path.denoise, limit);
        const double predicted = plan.predicted->total();
        // The prediction has taken time, so less is left now
        const double left_for_drawing = largest_drawing_share * options.seconds_left();
        if (plan.reduction() > 1) warn_of_reduction(plan.reduction());
        if (predicted <= left_for_drawing) return plan;
        if (plan.picture.shading == Shading::hybrid || needs_all_pixels) {
            warn_of_late_picture(predicted, left_for_drawing);
            return plan;
        }
        warn_of_smooth_shading(predicted, left_for_drawing);
        plan.picture = quick_options(plan.picture);
    }
    plan.predicted = predict_time_of_elements(scene, solution, ray_caster, view, plan.picture);
    return plan;
}

/// Limits drawing to the time that is left.
void limit_drawing(DrawingPlan& plan, const RenderArguments& options) {
    if (!plan.predicted || plan.reduction() > 1) return;
    PictureOptions& picture = plan.picture;
    picture.time = std::max(shortest_time, options.seconds_left() - plan.predicted->finishing);
    // Both the time and, if given, --samples limit the number of samples
    if (!options.has_default_samples) picture.max_samples = picture.samples;
    if (picture.shading == Shading::hybrid)
        picture.samples = std::min(picture.samples, plan.predicted->samples_within(picture.time));
}

}  // namespace

PlannedSolution solve_in_time(const Scene& scene, const RayCaster& ray_caster, const View& view,
                              SolveOptions solve_options, const RenderArguments& options) {
    const double left = std::max(shortest_time, options.seconds_left());
    const double seconds_to_plan = std::min(1.0, left / 10);
    solve_options.limits.time = left / 3;  // provisional, until drawing is planned
    DrawingPlan plan{options.picture};
    const auto plan_and_limit = [&](const Solution& so_far) -> std::optional<Limits> {
        plan = plan_drawing(scene, so_far, ray_caster, view, options);
        Limits limits = solve_options.limits;
        limits.time = time_limit_of_solving(so_far, plan, options);
        return limits;
    };
    Solution solution = run_solve(scene, ray_caster, solve_options, options.solver.memory, /*checkpoints=*/{},
                                  {.after = seconds_to_plan, .use = plan_and_limit});
    // A short run may end before drawing is planned. After a signal, no paths are traced, so no plan is needed.
    // For shadings without paths, `predicted` remains empty, and limit_drawing() does nothing.
    const bool needs_plan = !plan.predicted && traces_paths(options.picture.shading) && !is_stop_requested();
    if (needs_plan) plan = plan_drawing(scene, solution, ray_caster, view, options);
    limit_drawing(plan, options);
    return {std::move(solution), plan};
}

}  // namespace interflect::command
