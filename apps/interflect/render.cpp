#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>

#include "apps/interflect/commands.h"
#include "apps/interflect/distinct_files.h"
#include "apps/interflect/parse.h"
#include "apps/interflect/run_path_tracer.h"
#include "apps/interflect/run_solve.h"
#include "apps/interflect/show.h"
#include "apps/interflect/signals.h"
#include "apps/interflect/threads.h"
#include "interflect/base/error.h"
#include "interflect/base/pending_file.h"
#include "interflect/exports/solution_file.h"
#include "interflect/image/image_files.h"
#include "interflect/image/outlines.h"
#include "interflect/image/render.h"
#include "interflect/image/tone_map.h"
#include "interflect/raycast/camera.h"
#include "interflect/scene/view.h"

namespace interflect::command {

namespace {

/// Where the light in the picture comes from.
enum class PictureShading {
    smooth,  ///< A solution, see Shading.
    flat,
    path,  ///< Path tracing, with no solution.
};

struct RenderArguments {
    SceneOptions scene;
    MeshOptions mesh;
    ViewOptions view;
    SolverOptions solver;
    PathTracerArguments path;
    std::filesystem::path output;
    Size size;
    PictureShading shading = PictureShading::smooth;
    std::optional<int> samples;
    RenderOptions render;
    std::optional<float> exposure;
    Tonemap tonemap = Tonemap::filmic;
    Shown shown = Shown::light;
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

/// What goes to the file, and what is said of it.
struct Picture {
    Image image;
    std::string quantity = "luminance [cd/m^2]";
    float exposure = 0;
    std::int64_t non_finite_pixels = 0;
};

/// Tone-mapped in formats for people.
Picture picture_of_light(const Image& light, std::int64_t non_finite_pixels, const RenderArguments& options) {
    Picture picture;
    picture.exposure = options.exposure.value_or(automatic_exposure(light));
    picture.non_finite_pixels = non_finite_pixels;
    const bool tone_mapped = needs_tone_mapping(require_image_format(options.output));
    picture.image = tone_mapped ? tone_map(light, picture.exposure, options.tonemap) : light;
    return picture;
}

Picture draw_light(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                   const RenderArguments& options) {
    const Rendering rendering =
        render(solved.scene, *solved.solution.forest, ray_caster, view, solved.solution.irradiance, options.render);
    Picture picture = picture_of_light(rendering.image, rendering.non_finite_pixels, options);
    if (options.shown == Shown::mesh)
        picture.image = draw_outlines(picture.image, solved.scene, *solved.solution.forest, ray_caster, view,
                                      options.render.samples, options.render.seed);
    return picture;
}

/// In false colours for people, as numbers in formats to measure with.
Picture draw_quantity(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                      const RenderArguments& options) {
    const EyeSampling sampling{options.size.width, options.size.height, options.render.samples, options.render.seed};
    QuantityPicture drawn = show_quantity(options.shown, solved, ray_caster, view, sampling);
    const bool for_people = needs_tone_mapping(require_image_format(options.output));
    return {for_people ? std::move(drawn.shown) : std::move(drawn.values), label_of(options.shown), 0,
            drawn.non_finite_pixels};
}

void write_picture(PendingFile& output, const Picture& picture, const View& view, const Scene& scene,
                   std::uint64_t seed, const RenderArguments& options) {
    write_image(output.temporary_path(), picture.image,
                {view, picture.quantity, scene.name, INTERFLECT_VERSION, seed, picture.exposure});
    output.commit();
    if (picture.non_finite_pixels > 0) spdlog::warn("{} pixels are not finite", picture.non_finite_pixels);
    spdlog::info("{}: {} x {}, view '{}', {}, exposure {:+.2f}", options.output.string(), picture.image.width,
                 picture.image.height, view.name, picture.quantity, picture.exposure);
}

/// Draws the light of a solution; solves a scene first.
void run_solution(RenderArguments& options, PendingFile& output) {
    const bool solved_before = is_solution_file(options.scene.path);
    SolvedScene solved;
    if (solved_before)
        solved = read_solution(options.scene.path);
    else
        solved.scene = options.scene.load();
    const View view = view_to_draw(solved.scene, options.view);
    Camera(view, options.size.width, options.size.height, solved.scene.origin);  // refuses what defines no picture
    if (options.shown == Shown::mesh && !needs_tone_mapping(require_image_format(options.output)))
        throw InputError(options.output, 0, "outlines of the mesh are for pictures to look at: expected .png or .jpg");
    const float aspect = static_cast<float>(options.size.width) / static_cast<float>(options.size.height);
    const SolveOptions solve_options = options.solver.resolved({view}, aspect, options.size.height);
    if (!solved_before)
        solved.scene = options.mesh.divide(std::move(solved.scene), options.scene.read, solve_options.method.refines);
    const RayCaster ray_caster(solved.scene);
    if (!solved_before) solved.solution = run_solve(solved.scene, ray_caster, solve_options, options.solver);

    options.render.width = options.size.width;
    options.render.height = options.size.height;
    options.render.samples = options.samples.value_or(options.render.samples);
    options.render.shading = options.shading == PictureShading::flat ? Shading::flat : Shading::smooth;
    const Picture picture = is_quantity(options.shown) ? draw_quantity(solved, ray_caster, view, options)
                                                       : draw_light(solved, ray_caster, view, options);
    write_picture(output, picture, view, solved.scene, solved.solution.options.seed, options);
}

/// Draws the light that path tracing finds; of a solution file the scene alone counts.
void run_paths(const RenderArguments& options, PendingFile& output) {
    const Scene scene =
        is_solution_file(options.scene.path) ? read_solution(options.scene.path).scene : options.scene.load();
    const View view = view_to_draw(scene, options.view);
    PathOptions path_options;
    path_options.width = options.size.width;
    path_options.height = options.size.height;
    path_options.samples = options.samples.value_or(path_options.samples);
    path_options.until = options.solver.until();
    path_options.seed = options.solver.seed();
    const PathTracing traced = run_path_tracer(scene, RayCaster(scene), view, path_options, options.path);
    const Picture picture = picture_of_light(traced.image, traced.non_finite_pixels, options);
    write_picture(output, picture, view, scene, path_options.seed, options);
}

/// Everything that can be refused is refused before the first ray.
void run(RenderArguments& options, const CLI::App& command, int& exit_code) {
    const ThreadLimit threads(options.solver.threads);
    require_image_format(options.output);
    if (options.shading == PictureShading::path)
        refuse_solver_options(command);
    else
        refuse_path_options(command);
    require_distinct_files(std::array<NamedFile, 4>{{{"the scene", options.scene.path},
                                                     {"--output", options.output},
                                                     {"--stats", options.solver.stats},
                                                     {"--error-image", options.path.error_image}}});
    PendingFile output(options.output);
    if (options.shading == PictureShading::path)
        run_paths(options, output);
    else
        run_solution(options, output);
    if (is_stop_requested()) exit_code = interrupted;
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderArguments>();
    CLI::App& command =
        *app.add_subcommand("render", "Draw a view of a solution, or of a scene after solving it or by path tracing");
    options->scene.add_to(command, "Scene file (.mgf), solved first, or solution file (.h5)");
    command.add_option("-o,--output", options->output, "Picture to write: .png .jpg .exr .hdr")
        ->required()
        ->type_name("FILE");
    options->view.add_to(command);
    add_parsed(command, "--size", options->size, parse_size, "Picture size in pixels")
        ->type_name("WxH")
        ->default_str("1280x720");
    command.add_option("--samples", options->samples, "Eye rays a pixel (default: 16; with --shading path 64)")
        ->check(CLI::Range(1, 65536));
    add_choice<PictureShading>(
        command, "--shading", options->shading,
        {{"smooth", PictureShading::smooth}, {"flat", PictureShading::flat}, {"path", PictureShading::path}},
        "smooth: interpolated over each surface; flat: one value an element; path: path tracing, without solving")
        ->default_str("smooth");
    options->path.add_to(command);
    command
        .add_option("--exposure", options->exposure,
                    "Brightness of .png and .jpg: 1 more is twice as bright (default: automatic)")
        ->type_name("STOPS")
        ->check(number_between(-100, 100));
    add_choice<Tonemap>(command, "--tonemap", options->tonemap,
                        {{"filmic", Tonemap::filmic}, {"reinhard", Tonemap::reinhard}, {"linear", Tonemap::linear}},
                        "Curve of .png and .jpg")
        ->default_str("filmic");
    add_show(command, options->shown);
    options->solver.add_to(command);
    options->mesh.add_to(command);
    command.callback([options, &command, &exit_code] { run(*options, command, exit_code); });
}

}  // namespace interflect::command
