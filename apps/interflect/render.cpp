#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "apps/interflect/commands.h"
#include "apps/interflect/parse.h"
#include "apps/interflect/run_solve.h"
#include "apps/interflect/threads.h"
#include "interflect/base/error.h"
#include "interflect/base/pending_file.h"
#include "interflect/exports/solution_file.h"
#include "interflect/image/image_files.h"
#include "interflect/image/render.h"
#include "interflect/image/tone_map.h"
#include "interflect/raycast/camera.h"
#include "interflect/scene/view.h"

namespace interflect::command {

namespace {

struct Options {
    SceneOptions scene;
    MeshOptions mesh;
    ViewOptions view;
    SolverOptions solver;
    std::filesystem::path output;
    Size size;
    RenderOptions render;
    std::optional<float> exposure;
    Tonemap tonemap = Tonemap::filmic;
};

/// The one view to draw: as asked for, else the scene's first, else an overview.
View view_to_draw(const Scene& scene, const ViewOptions& options) {
    const std::vector<View> views = options.views(scene);
    if (views.size() > 1) throw InputError("a picture has one view, but several were given");
    if (views.size() == 1) return views.front();
    if (!scene.views.empty()) return scene.views.front();
    spdlog::warn("{} names no view and none was given: drawing an overview (--eye and --look-at choose another)",
                 scene.name);
    return overview(scene);
}

void write_picture(PendingFile& output, const Rendering& rendering, const View& view, const SolvedScene& solved,
                   const Options& options) {
    const float exposure = options.exposure.value_or(automatic_exposure(rendering.image));
    const ImageMetadata metadata{
        view, "luminance [cd/m^2]", solved.scene.name, INTERFLECT_VERSION, solved.solution.options.seed, exposure};
    const bool tone_mapped = needs_tone_mapping(require_image_format(options.output));
    write_image(output.temporary_path(),
                tone_mapped ? tone_map(rendering.image, exposure, options.tonemap) : rendering.image, metadata);
    output.commit();
    if (rendering.non_finite_pixels > 0) spdlog::warn("{} pixels are not finite", rendering.non_finite_pixels);
    spdlog::info("{}: {} x {}, view '{}', exposure {:+.2f}", options.output.string(), rendering.image.width,
                 rendering.image.height, view.name, exposure);
}

/// Everything that can be refused is refused before the first ray.
void run(Options& options, int& exit_code) {
    const ThreadLimit threads(options.solver.threads);
    require_image_format(options.output);
    PendingFile output(options.output);
    const bool solved_before = is_solution_file(options.scene.path);
    SolvedScene solved;
    if (solved_before)
        solved = read_solution(options.scene.path);
    else
        solved.scene = options.scene.load();
    const View view = view_to_draw(solved.scene, options.view);
    Camera(view, options.size.width, options.size.height);  // refuses what defines no picture
    const float aspect = static_cast<float>(options.size.width) / static_cast<float>(options.size.height);
    const SolveOptions solve_options = options.solver.resolved({view}, aspect);
    if (!solved_before)
        solved.scene = options.mesh.divide(std::move(solved.scene), options.scene.read, solve_options.method.refines);
    const RayCaster ray_caster(solved.scene);
    if (!solved_before) solved.solution = run_solve(solved.scene, ray_caster, solve_options, options.solver);

    options.render.width = options.size.width;
    options.render.height = options.size.height;
    options.render.seed = solved.solution.options.seed;
    const Rendering rendering =
        render(solved.scene, *solved.solution.forest, ray_caster, view, solved.solution.irradiance, options.render);
    write_picture(output, rendering, view, solved, options);
    if (!solved_before && solved.solution.interrupted) exit_code = interrupted;
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand("render", "Draw a view of a solution, or of a scene after solving it");
    options->scene.add_to(command, "Scene file (.mgf), solved first, or solution file (.h5)");
    command.add_option("-o,--output", options->output, "Picture to write: .png .jpg .exr .hdr")
        ->required()
        ->type_name("FILE");
    options->view.add_to(command);
    add_parsed(command, "--size", options->size, parse_size, "Picture size in pixels")
        ->type_name("WxH")
        ->default_str("1280x720");
    command.add_option("--samples", options->render.samples, "Eye rays a pixel")
        ->capture_default_str()
        ->check(CLI::Range(1, 65536));
    add_choice<Shading>(command, "--shading", options->render.shading,
                        {{"smooth", Shading::smooth}, {"flat", Shading::flat}},
                        "smooth: interpolated over each surface; flat: one value an element")
        ->default_str("smooth");
    command
        .add_option("--exposure", options->exposure,
                    "Brightness of .png and .jpg: 1 more is twice as bright (default: automatic)")
        ->type_name("STOPS")
        ->check(number_between(-100, 100));
    add_choice<Tonemap>(command, "--tonemap", options->tonemap,
                        {{"filmic", Tonemap::filmic}, {"reinhard", Tonemap::reinhard}, {"linear", Tonemap::linear}},
                        "Curve of .png and .jpg")
        ->default_str("filmic");
    options->solver.add_to(command);
    options->mesh.add_to(command);
    command.callback([options, &exit_code] { run(*options, exit_code); });
}

}  // namespace interflect::command
