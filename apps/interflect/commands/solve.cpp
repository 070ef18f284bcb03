#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/solving/run_solve.h"
#include "apps/interflect/solving/setup_warnings.h"
#include "apps/interflect/solving/stats_file.h"
#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/base/files/input_file.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/solution.h"

namespace interflect::command {

using namespace detail;

namespace {

/// @param others  Without the checkpoint itself: after a failed save, the previous one is another name of it.
void require_distinct_previous(const Checkpoints& checkpoints, std::span<const NamedFile> others) {
    const NamedFile previous{"the previous checkpoint (--checkpoint)", checkpoints.previous()};
    require_distinct_files(others, {&previous, 1});
}

void require_solution_name(const std::filesystem::path& path) {
    if (path.extension() != ".h5")
        throw UsageError(
            "--output",
            fmt::format("a solution file is HDF5: expected a name that ends in .h5, found '{}'", path.string()));
}

void write(PendingFile& output, const Scene& scene, const Solution& solution) {
    output.write_by([&](const std::filesystem::path& path) { write_solution(path, scene, solution); });
    output.commit();
}

}  // namespace

void add_solve(CLI::App& app, int& exit_code) {
    struct Options {
        SceneOptions scene;
        MeshOptions mesh;
        ViewOptions view;
        LightGroupOptions groups;
        SolverOptions solver;
        Checkpoints checkpoints;
        std::filesystem::path output;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand("solve", "Solve for the light on the surfaces of a scene");
    options->scene.add_to(command);
    command.add_option("-o,--output", options->output, "Solution file to write (.h5)")->required()->type_name("FILE");
    options->solver.add_to(command);
    options->checkpoints.add_to(command, "Save the run to this file now and then (.h5); `resume` goes on with it");
    command.get_option("--every")->needs("--checkpoint");
    options->mesh.add_to(command);
    options->view.add_to(command);
    options->groups.add_to(command);
    command.callback([options, &command, &exit_code] {
        const ThreadLimit threads(options->solver.threads);
        require_solution_name(options->output);
        options->scene.check(command);
        options->view.check();
        options->groups.check();
        const std::array<NamedFile, 3> outputs{{{"--output", options->output},
                                                {"--stats", options->solver.stats},
                                                {"--checkpoint", options->checkpoints.file}}};
        const auto inputs = input_files(options->scene, options->view);
        require_distinct_files(inputs, outputs);
        require_distinct_previous(options->checkpoints, inputs);
        require_distinct_previous(options->checkpoints, std::span(outputs).first(2));
        require_text_name({"--stats", options->solver.stats});
        options->checkpoints.require_writable();
        PendingFile output(options->output);
        Scene scene = options->scene.load();
        refuse_overwriting(scene, outputs);
        options->checkpoints.require_own_previous(scene);
        const std::vector<View> views = options->view.views(scene);
        const SolveOptions solve_options = options->solver.resolved(views);
        scene = options->mesh.divide(std::move(scene), options->scene.read, solve_options.method.refines);
        options->groups.set_groups(scene);
        // Requested views come first: `render` draws the first view of a solution.
        std::erase_if(scene.views,
                      [&](const View& view) { return std::find(views.begin(), views.end(), view) != views.end(); });
        scene.views.insert(scene.views.begin(), views.begin(), views.end());
        StatsFile stats(options->solver.threads, options->solver.stats);
        const RayCaster ray_caster = make_ray_caster(scene);
        warn_of_setup(scene, ray_caster);
        const Solution solution =
            run_solve(scene, ray_caster, solve_options, options->solver.memory, options->checkpoints);
        write(output, scene, solution);
        stats.write(scene, solution);
        if (is_stop_requested()) exit_code = interrupted;
    });
}

void add_resume(CLI::App& app, int& exit_code) {
    struct Options {
        std::filesystem::path input, output, stats;
        GivenLimits limits;
        Checkpoints checkpoints;
        int threads = 0;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand("resume", "Continue a saved run, with the bits of an uninterrupted one");
    command.add_option("FILE", options->input, "What --checkpoint wrote")->required();
    command.add_option("-o,--output", options->output, "Solution file to write (.h5)")->required()->type_name("FILE");
    add_limits(command, options->limits);
    options->checkpoints.add_to(command, "Save the run to this file now and then (default: FILE itself)");
    command.add_option("--stats", options->stats, "File for statistics of each iteration, as JSON lines")
        ->type_name("FILE");
    add_threads(command, options->threads);
    command.callback([options, &exit_code] {
        const ThreadLimit threads(options->threads);
        if (options->input.extension() != ".h5")
            throw InputError(options->input, 0, "a checkpoint is a solution file: expected a name that ends in .h5");
        if (options->checkpoints.file.empty()) options->checkpoints.file = options->input;
        require_solution_name(options->output);
        const std::array<NamedFile, 3> outputs{
            {{"--output", options->output}, {"--stats", options->stats}, {"--checkpoint", options->checkpoints.file}}};
        const NamedFile input{"FILE", options->input};
        require_distinct_files({&input, 1}, std::span(outputs).first(2));
        require_distinct_files({}, outputs);
        require_distinct_previous(options->checkpoints, std::span(outputs).first(2));
        if (options->checkpoints.file != options->input) require_distinct_previous(options->checkpoints, {&input, 1});
        require_text_name({"--stats", options->stats});
        require_regular_file(options->input);
        options->checkpoints.require_writable();
        PendingFile output(options->output);
        Solver solver = Solver::open(options->input);
        if (options->limits.any()) solver.set_plan(options->limits.limits());
        const std::shared_ptr<const Scene> scene = solver.shared_scene();
        refuse_overwriting(*scene, outputs);
        options->checkpoints.require_own_previous(*scene);
        StatsFile stats(options->threads, options->stats);
        const Solution solution = run_to_end(std::move(solver), options->checkpoints);
        write(output, *scene, solution);
        stats.write(*scene, solution);
        if (is_stop_requested()) exit_code = interrupted;
    });
}

}  // namespace interflect::command
