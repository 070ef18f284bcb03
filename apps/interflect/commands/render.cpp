#include <spdlog/spdlog.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/drawing/view_check.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/render/complete_options.h"
#include "apps/interflect/render/draw_view.h"
#include "apps/interflect/render/drawing_plan.h"
#include "apps/interflect/render/pictures.h"
#include "apps/interflect/render/previews.h"
#include "apps/interflect/render/render_arguments.h"
#include "apps/interflect/solving/read_light.h"
#include "apps/interflect/solving/run_solve.h"
#include "apps/interflect/solving/stats_file.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/prepare.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

using namespace detail;

namespace {

/// Returns the requested view, else the first view of the scene, if any.
std::optional<View> find_view(const Scene& scene, const RenderArguments& options) {
    // Computes and logs the scale of a section for the rows above the legend
    if (options.section.is_given()) return options.section.view(scene, options.size.width, options.view_rows());
    const std::vector<View> requested = options.view.views(scene);
    if (!requested.empty()) return requested.front();  // complete_options() refuses several views
    if (!scene.views.empty()) return scene.views.front();
    return std::nullopt;
}

/// Returns an overview and warns about it.
View make_overview(const Scene& scene, const RayCaster& ray_caster) {
    spdlog::warn(
        "{} names no view, and the command line has none: drawing an overview (--eye and --look-at choose another)",
        scene.name);
    return overview(scene, ray_caster);
}

/// @throws InputError if the view is invalid, or too narrow for this number of pixels.
void require_picture_of(const View& view, const Scene& scene, const RenderArguments& options) {
    require_picture(view, options.size.width, options.size.height, scene.origin);
}

/// Whether the run concentrates rays on the surfaces of the view. A floor plan or section shows the whole scene
/// equally, so importance has no benefit.
bool uses_importance(const RenderArguments& options) { return !options.section.is_given(); }

SolveOptions solve_options_for(const View& view, const RenderArguments& options) {
    const std::vector<View> views = uses_importance(options) ? std::vector{view} : std::vector<View>();
    return options.solver.resolved(views, options.aspect(), options.size.height);
}

/// Solves without a time limit, and writes previews of the light so far.
Solution solve_with_previews(const Scene& scene, const RayCaster& ray_caster, const View& view,
                             const SolveOptions& solve_options, const RenderArguments& options) {
    // Drawing a preview takes about a second, so shorter runs draw none. With --progressive, a viewer waits for the
    // first one, so it is drawn earlier.
    const double seconds_to_preview = options.progressive ? 0.25 : 1;
    const auto write_light = [&](const Solution& so_far) -> std::optional<Limits> {
        write_preview(scene, so_far, ray_caster, view, options, usual_reduction);
        return std::nullopt;  // the limits remain
    };
    return run_solve(scene, ray_caster, solve_options, options.solver.memory, /*checkpoints=*/{},
                     {.after = seconds_to_preview, .repeats = options.progressive, .use = write_light});
}

/// Writes a preview of the finished light, before paths are traced. With --progressive, it is finer than earlier ones.
void write_preview_of_solution(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                               const RenderArguments& options) {
    if (!traces_paths(options.picture.shading) || is_stop_requested()) return;
    const double reduction = options.progressive ? usual_reduction / 2 : usual_reduction;
    write_preview(solved.scene, solved.solution, ray_caster, view, options, reduction);
}

/// Draws a solution. If the input is a scene, solves it first.
void render_solution(const RenderArguments& options, PendingFile& output) {
    const bool is_solved = is_solution_file(options.scene.path);
    SolvedScene solved = read_scene_or_solution(options.scene, options.dimming);
    Scene& scene = solved.scene;
    refuse_overwriting(scene, options.outputs());
    const std::optional<View> found_view = find_view(scene, options);
    if (found_view) require_picture_of(*found_view, scene, options);
    if (!is_solved)
        scene = options.mesh.divide(std::move(scene), options.scene.read,
                                    options.solver.method_refines(uses_importance(options)));
    StatsFile stats(options.solver.threads, options.solver.stats);
    const RayCaster ray_caster = make_ray_caster(scene);
    const View view = found_view ? *found_view : make_overview(scene, ray_caster);
    if (!found_view) require_picture_of(view, scene, options);
    warn_of_camera_outside(scene, ray_caster, view, options.aspect());

    DrawingPlan plan{options.picture};
    if (!is_solved && options.has_time_limit()) {  // complete_options() refuses a time limit for a solution file
        PlannedSolution planned = solve_in_time(scene, ray_caster, view, solve_options_for(view, options), options);
        solved.solution = std::move(planned.solution);
        plan = planned.plan;
    } else {
        if (!is_solved)
            solved.solution = solve_with_previews(scene, ray_caster, view, solve_options_for(view, options), options);
        write_preview_of_solution(solved, ray_caster, view, options);
    }

    const Picture picture = draw_solution(solved, ray_caster, view, plan, options);
    if (picture.is_black) warn_of_darkness(scene, ray_caster, view, options.aspect());
    write_picture(output, picture, view, scene, solved.solution.options.seed, options);
    if (!is_solved) stats.write(scene, solved.solution);
}

/// Draws a scene by tracing paths without a solution. Reads only the scene of a solution file.
void render_paths(const RenderArguments& options, PendingFile& output) {
    Scene scene = read_scene_or_solution(options.scene, options.dimming).scene;
    refuse_overwriting(scene, options.outputs());
    const std::optional<View> found_view = find_view(scene, options);
    if (found_view) require_picture_of(*found_view, scene, options);
    // Without elements, patches need no mesh size: they are cut at contacts, but not divided
    if (!is_solution_file(options.scene.path)) scene = options.mesh.cut(std::move(scene), options.scene.read);
    const RayCaster ray_caster = make_ray_caster(scene);
    const View view = found_view ? *found_view : make_overview(scene, ray_caster);
    if (!found_view) require_picture_of(view, scene, options);
    warn_of_camera_outside(scene, ray_caster, view, options.aspect());
    const Picture picture = draw_paths(scene, /*solution=*/nullptr, ray_caster, view, options.picture, options);
    if (picture.is_black) warn_of_darkness(scene, ray_caster, view, options.aspect());
    write_picture(output, picture, view, scene, options.solver.seed(), options);
}

void run(RenderArguments& options, const CLI::App& command, int& exit_code) {
    const ThreadLimit threads(options.solver.threads);
    complete_options(options, command);
    PendingFile output(options.output);
    if (needs_solution(options.picture.shading))
        render_solution(options, output);
    else
        render_paths(options, output);
    if (is_stop_requested()) exit_code = interrupted;
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderArguments>();
    CLI::App& command =
        *app.add_subcommand("render", "Draw a view of a solution, or of a scene after solving it or by path tracing");
    options->add_to(command);
    command.callback([options, &command, &exit_code] { run(*options, command, exit_code); });
}

}  // namespace interflect::command
