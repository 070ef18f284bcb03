#include <fmt/format.h>

#include <array>
#include <memory>

#include "apps/interflect/commands.h"
#include "apps/interflect/distinct_files.h"
#include "apps/interflect/run_solve.h"
#include "apps/interflect/signals.h"
#include "apps/interflect/stats_file.h"
#include "apps/interflect/threads.h"
#include "interflect/base/error.h"
#include "interflect/base/pending_file.h"
#include "interflect/exports/solution_file.h"

namespace interflect::command {

namespace {

void require_solution_name(const std::filesystem::path& path) {
    if (path.extension() != ".h5")
        throw InputError(path, 0, "a solution file is HDF5: expected a name that ends in .h5");
}

void write(PendingFile& output, const Scene& scene, const Solution& solution) {
    try {
        write_solution(output.temporary_path(), scene, solution);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("cannot write '{}': {}", output.final_path().string(), e.what()));
    }
    output.commit();
}

}  // namespace

void add_solve(CLI::App& app, int& exit_code) {
    struct Options {
        SceneOptions scene;
        MeshOptions mesh;
        ViewOptions view;
        SolverOptions solver;
        std::filesystem::path output;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand("solve", "Find the light on the surfaces of a scene");
    options->scene.add_to(command);
    command.add_option("-o,--output", options->output, "Solution file to write (.h5)")->required()->type_name("FILE");
    options->solver.add_to(command);
    options->mesh.add_to(command);
    options->view.add_to(command);
    command.callback([options, &exit_code] {
        const ThreadLimit threads(options->solver.threads);
        require_solution_name(options->output);
        require_distinct_files(
            input_files(options->scene, options->view),
            std::array<NamedFile, 2>{{{"--output", options->output}, {"--stats", options->solver.stats}}});
        PendingFile output(options->output);
        Scene scene = options->scene.load();
        const std::vector<View> views = options->view.views(scene);
        const SolveOptions solve_options = options->solver.resolved(views);
        scene = options->mesh.divide(std::move(scene), options->scene.read, solve_options.method.refines);
        StatsFile stats(options->solver, scene);
        const RayCaster ray_caster(scene);
        const Solution solution = run_solve(scene, ray_caster, solve_options, options->solver.memory);
        // What was asked for comes first: `render` takes the first view of a solution.
        scene.views.insert(scene.views.begin(), views.begin(), views.end());
        write(output, scene, solution);
        stats.write(scene, solution);
        if (is_stop_requested()) exit_code = interrupted;
    });
}

}  // namespace interflect::command
