#include "interflect/export.h"

#include <spdlog/spdlog.h>

#include <memory>

#include "apps/interflect/commands.h"
#include "apps/interflect/distinct_files.h"
#include "apps/interflect/parse.h"
#include "apps/interflect/up_axis.h"
#include "interflect/error.h"
#include "interflect/render.h"
#include "interflect/scene/view.h"
#include "interflect/solution_file.h"
#include "interflect/tone_map.h"

namespace interflect::command {

namespace {

struct ExportArguments {
    std::filesystem::path input, output;
    Exposure exposure;
    std::optional<Imath::V3d> up;
};

/// As `render` chooses it for the scene's first view, else for an overview.
float automatic_exposure_of(const SolvedScene& solved) {
    const RayCaster ray_caster(solved.scene);
    const View view = solved.scene.views.empty() ? overview(solved.scene) : solved.scene.views.front();
    RenderOptions options;
    options.width = 160;
    options.height = 90;
    options.samples = 4;
    return automatic_exposure(render(solved.scene, solved.solution, ray_caster, view, options).image);
}

V3f up_of(const Scene& scene) {
    const std::optional<UpAxis> found = find_up_axis(scene);
    if (!found) {
        spdlog::warn("{}: nothing tells which way is up: taking z (--up chooses another)", scene.name);
        return {0, 0, 1};
    }
    const std::string axis = found->axis;
    V3f up(0);
    up[axis.back() - 'x'] = axis.front() == '-' ? -1.0f : 1.0f;
    return up;
}

void run(const ExportArguments& arguments) {
    require_export_format(arguments.output);
    const NamedFile input{"the solution", arguments.input}, output{"--output", arguments.output};
    require_distinct_files({&input, 1}, {&output, 1});
    const SolvedScene solved = read_solution(arguments.input);
    ExportOptions options;
    options.exposure = arguments.exposure.stops + (arguments.exposure.relative ? automatic_exposure_of(solved) : 0);
    options.up = arguments.up ? V3f(*arguments.up) : up_of(solved.scene);
    for (const auto& path : export_solution(arguments.output, solved.scene, solved.solution, options))
        spdlog::info("{}: exposure {:+.2f}", path.string(), options.exposure);
}

}  // namespace

void add_export(CLI::App& app) {
    const auto options = std::make_shared<ExportArguments>();
    CLI::App& command = *app.add_subcommand("export", "Write a solved scene for other programs");
    command.add_option("solution", options->input, "Solution file (.h5)")->required()->type_name("FILE");
    std::string extensions;
    for (const ExportFormat& format : export_formats) extensions += std::string(" ") + format.extension;
    command.add_option("-o,--output", options->output, "File to write:" + extensions)->required()->type_name("FILE");
    add_parsed(command, "--exposure", options->exposure, parse_exposure,
               "Stops by which colours are brightened, or auto, as `render` does")
        ->type_name("STOPS|auto[+STOPS]")
        ->default_str("auto");
    add_parsed(command, "--up", options->up, parse_vector, "Which way is up (default: that of the views, or the light)")
        ->type_name("X,Y,Z");
    command.callback([options] { run(*options); });
}

}  // namespace interflect::command
