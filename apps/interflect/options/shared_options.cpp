#include "apps/interflect/options/shared_options.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "apps/interflect/options/refused_options.h"
#include "apps/interflect/processes/long_work.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"
#include "interflect/load.h"
#include "interflect/prepare.h"
#include "interflect/scene.h"

namespace interflect::command {

using namespace detail;

namespace {

bool is_patch_limit(const InputError& e) { return e.fault().setting == "max_patches"; }

/// Memory while a scene is read, cut and prepared for ray tracing [bytes]. The largest measured values were 290, for a
/// sphere with 200 divisions and for glTF instances of one triangle.
constexpr std::size_t bytes_per_patch = 300;

/// Returns the number of patches that fit into memory. @param present  Number of patches already in memory, included.
std::uint64_t patches_in_memory(std::size_t present = 0) { return present + free_memory() / bytes_per_patch; }

}  // namespace

void SceneOptions::add_to(CLI::App& app, const std::string& what) {
    app.add_option("SCENE", path, what)->required()->type_name("FILE");
    app.add_option("MORE", read.further_files,
                   "More files of a Radiance scene (.rad, .mat), which see the modifiers of earlier ones as in oconv")
        ->type_name("FILE");
    app.add_option("--curve-divisions", read.curve_divisions, "Flat pieces per quarter circle of curved surfaces")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000))
        ->group(reading_group);
    add_parsed(app, "--unit", read.unit, parse_unit,
               "Unit of the lengths in the file: m, cm, mm, km, in, ft, or so many metres")
        ->type_name("UNIT")
        ->default_str("m");
    add_choice<Axis>(app, "--up-axis", read.up_axis,
                     {{"x", Axis::x},
                      {"-x", Axis::minus_x},
                      {"y", Axis::y},
                      {"-y", Axis::minus_y},
                      {"z", Axis::z},
                      {"-z", Axis::minus_z}},
                     "Axis of the file that points up; it becomes z")
        ->default_str("z");
    app.add_flag("--outside-files", read.outside_files,
                 "Also read files outside of the scene's folder that the scene names")
        ->group(reading_group);
    add_parsed(app, "--max-patches", read.max_patches, parse_count,
               "Maximum number of patches; a scene with more is refused")
        ->type_name("COUNT")
        ->default_str("50M")
        ->group(reading_group);
    const auto place = [this](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) try {
                luminaires.push_back(parse_luminaire(text));
            } catch (const std::invalid_argument& e) {
                throw CLI::ValidationError("--luminaire", e.what());
            }
    };
    app.add_option_function<std::vector<std::string>>(
           "--luminaire", place,
           "Place measured light (.ies, .ldt) at X,Y,Z [m], aimed at the "
           "point AX,AY,AZ (default: straight down, -z), and "
           "turned about its axis; lumens: of its lamps; mount=top: by the top of its "
           "opening, not by the middle (may be repeated)")
        ->type_name("FILE@X,Y,Z[,AX,AY,AZ][,turn=DEGREES][,lumens=LM][,maintenance=FACTOR][,mount=top]")
        ->allow_extra_args(false);
    add_daylight_to(app);
}

void SceneOptions::add_daylight_to(CLI::App& app) {
    const auto group = [](CLI::Option* option) { return option->group(daylight_group); };
    const auto set_sky = [this](const std::string& text) {
        try {
            const Sky sky = parse_sky(text);
            daylight.cie_sky = sky.cie;
            daylight.perez_sky = sky.perez;
        } catch (const std::invalid_argument& e) {
            throw CLI::ValidationError("--sky", e.what());
        }
    };
    CLI::Option* sky = group(
        app.add_option_function<std::string>(
               "--sky", set_sky,
               "Add a sky: overcast, uniform, intermediate or clear, another type of the CIE (cie-1 to cie-16), or "
               "Perez's, from direct normal and diffuse horizontal irradiance [W/m2]; LUX: horizontal illuminance of "
               "the sky alone (default: usual for that sky and sun)")
            ->type_name("MODEL[:LUX]|perez:DIRECT,DIFFUSE"));
    group(add_parsed(app, "--sun", daylight.sun, parse_sun,
                     "Add the sun: azimuth from north (y) over east (x) and altitude [degrees]; LUX: illuminance of a "
                     "surface that faces it (default: usual for the sky)")
              ->type_name("AZIMUTH,ALTITUDE[,LUX]"));
    group(app.add_option("--ground", daylight.ground_reflectance,
                         "Reflectance of the ground below the horizon, which sky and sun light")
              ->type_name("SHARE")
              ->capture_default_str()
              ->check(number_between(0, 1))
              ->needs(sky));
    group(add_parsed(app, "--environment", daylight.environment, parse_environment,
                     "Surround the scene with an image (.exr, .hdr) of longitudes and latitudes; ROTATION: azimuth in "
                     "its middle [degrees], SCALE: factor of its radiance")
              ->type_name("FILE[,ROTATION[,SCALE]]"));
    group(add_parsed(app, "--zenith", zenith_, parse_vector, "Up direction of sky and sun")->type_name("X,Y,Z"))
        ->default_str("0,0,1");
}

void SceneOptions::check(const CLI::App& command, bool traces_paths) const {
    refuse_scene_options(command, path, traces_paths);
    for (const std::filesystem::path& file : read.further_files)
        for (const std::filesystem::path& part : {path, file})
            if (const std::string extension = lower_case_extension(part); extension != ".rad" && extension != ".mat")
                throw UsageError("MORE", fmt::format("several files are one scene only if all are Radiance's (.rad, "
                                                     ".mat), not '{}' and '{}'",
                                                     path.string(), file.string()));
    check_daylight(command);
}

Daylight SceneOptions::placed_daylight() const {
    Daylight placed = daylight;
    placed.zenith = V3f(zenith_);
    return placed;
}

/// Checks daylight by adding one part after the other to an empty scene, so an error can name its option.
void SceneOptions::check_daylight(const CLI::App& command) const {
    constexpr std::array<std::string_view, 1> zenith = {"--zenith"};
    if (!daylight.sun && !daylight.cie_sky && !daylight.perez_sky && !daylight.environment)
        refuse_options(command, zenith, "it has no effect without --sky, --sun or --environment");
    const Daylight all = placed_daylight();
    const auto check = [](const char* option, const Daylight& part) {
        check_option(option, [&] {
            Scene empty;
            add_daylight(empty, part);
        });
    };
    Daylight part;
    part.zenith = all.zenith;
    check("--zenith", part);
    part.sun = all.sun;
    check("--sun", part);
    part.cie_sky = all.cie_sky;
    part.perez_sky = all.perez_sky;
    part.ground_reflectance = all.ground_reflectance;
    check("--sky", part);
}

Scene SceneOptions::load(bool needs_light) const {
    ReadOptions limited = read;
    limited.max_patches = std::min(read.max_patches, patches_in_memory());
    try {
        Scene scene = [&] {
            const LongWork work(fmt::format("reading {}", path.string()));
            return load_scene(path, limited, luminaires, placed_daylight());
        }();
        log_warnings(scene.warnings, needs_light ? "" : "no-light");
        return scene;
    } catch (const InputError& e) {
        if (is_patch_limit(e) && limited.max_patches < read.max_patches)
            throw std::runtime_error(fmt::format(
                "{}: the memory does not suffice for more: the limits of this process (its machine, ulimit -v, "
                "control groups) leave {} MiB; a scene of fewer copies, fewer --curve-divisions need less",
                e.what(), usable_memory() >> 20));
        throw;
    }
}

void log_warnings(const Warnings& warnings, std::string_view omitted) {
    for (const Warnings::Entry& w : warnings.entries()) {
        if (w.kind == omitted) continue;
        const std::string times = w.count > 1 ? fmt::format(" ({} times)", w.count) : "";
        spdlog::warn("{}{}{}", w.where.empty() ? "" : w.where + ": ", w.message, times);
    }
}

void MeshOptions::add_to(CLI::App& app) {
    add_parsed(app, "--mesh-size", size, parse_mesh_size,
               "Divide patches to this longest edge [m] before solving; auto: by the scene's size for methods that do "
               "not refine; none: as in the file")
        ->type_name("METRES|auto|none")
        ->default_str("auto")
        ->group(solver_group);
    app.add_flag("--contact-cuts,!--no-contact-cuts", contact_cuts,
                 "Cut faces where others stand on them, pass through or cover them, to prevent light leaks "
                 "(default), or leave them as in the file")
        ->group(solver_group);
}

Scene MeshOptions::cut(Scene scene, const ReadOptions& read) const {
    if (!contact_cuts) return scene;
    const Warnings earlier = std::exchange(scene.warnings, {});
    const std::size_t faces = scene.patches.size();
    {
        const LongWork work("cutting faces where others meet them");
        scene = cut_at_contacts(scene, {.min_extent = static_cast<float>(2 * default_element_size(scene)),
                                        .max_patches = std::min(read.max_patches, patches_in_memory(faces))});
    }
    log_warnings(scene.warnings);
    if (scene.patches.size() > faces)
        spdlog::info("faces are cut where others meet them: {} patches, before {}", scene.patches.size(), faces);
    scene.warnings = earlier;
    return scene;
}

Scene MeshOptions::divide(Scene scene, const ReadOptions& read, bool refines) const {
    scene = cut(std::move(scene), read);
    if (size == whole_patches || (size == automatic_mesh_size && refines)) return scene;
    const float edge = size == automatic_mesh_size ? default_mesh_size(scene) : size;
    const std::uint64_t most = std::min(read.max_patches, patches_in_memory(scene.patches.size()));
    try {
        return split_patches(scene, edge, most);
    } catch (const InputError& e) {
        if (!is_patch_limit(e)) throw;
        if (most < read.max_patches)
            throw std::runtime_error(
                fmt::format("{}: the memory does not suffice for more; use a larger --mesh-size", e.what()));
        throw InputError(fmt::format("{}; use a larger --mesh-size or raise --max-patches", e.what()));
    }
}

void ViewOptions::add_to(CLI::App& app) {
    add_without_up(app);
    add_parsed(app, "--up", up, parse_vector, "Up direction of the picture, with --eye")
        ->type_name("X,Y,Z")
        ->needs("--eye")
        ->default_str("0,0,1")
        ->group(view_group);
}

void ViewOptions::add_without_up(CLI::App& app) {
    const auto group = [](CLI::Option* option) {
        option->group(view_group);
        return option;
    };
    group(app.add_option("--view", names, "Name of a view that the scene has (may be repeated)")->type_name("NAME"));
    group(app.add_option("--view-file", files, "Radiance view file, .vf (may be repeated)")->type_name("FILE"));
    const auto vector_option = [&](const std::string& name, auto& v, const std::string& help) {
        return group(add_parsed(app, name, v, parse_vector, help)->type_name("X,Y,Z"));
    };
    CLI::Option* eye_option = vector_option("--eye", eye, "Position of the eye [m]");
    CLI::Option* look_at_option = vector_option("--look-at", look_at, "A point in the middle of the picture [m]");
    eye_option->needs(look_at_option);
    look_at_option->needs(eye_option);
    group(app.add_option("--fov", fov, "Vertical field of view of --eye [degrees]")
              ->needs(eye_option)
              ->capture_default_str()
              ->check(number_between(0.001, 179)));
}

void ViewOptions::check() const {
    if (!(up.length() > 0)) throw UsageError("--up", "0,0,0 is no direction");
    if (eye) check_option("--eye", [&] { require_picture(view_of_eye(), 1, 1, *eye); });
}

std::vector<View> ViewOptions::views(const Scene& scene) const {
    std::vector<View> views;
    if (!names.empty() && scene.views.empty())
        throw InputError(scene.name, 0,
                         fmt::format("there is no view '{}'; the scene has no named views: give --eye and --look-at",
                                     names.front()));
    for (const std::string& name : names) views.push_back(find_view(scene, name));
    for (const auto& file : files) views.push_back(read_radiance_view(file));
    if (eye) views.push_back(view_of_eye());
    for (const View& view : views) require_picture(view, 1, 1, scene.origin);
    return views;
}

std::vector<NamedFile> input_files(const SceneOptions& scene, const ViewOptions& view) {
    std::vector<NamedFile> files = {{"the scene", scene.path}, {"the scene's views", view_list_path(scene.path)}};
    for (const std::filesystem::path& file : scene.read.further_files) {
        files.push_back({"a file of the scene", file});
        files.push_back({"the scene's views", view_list_path(file)});
    }
    for (const std::filesystem::path& file : view.files) files.push_back({"--view-file", file});
    for (const PlacedLuminaire& placed : scene.luminaires) files.push_back({"--luminaire", placed.file});
    if (scene.daylight.environment) files.push_back({"--environment", scene.daylight.environment->file});
    return files;
}

void add_threads(CLI::App& app, int& threads) {
    app.add_option("--threads", threads, "Number of threads; 0: all of the machine. Results do not depend on it")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096));
}

void add_method(CLI::App& app, std::optional<Method>& method) {
    std::vector<std::pair<std::string, Method>> choices;
    choices.reserve(methods.size());
    for (const Method& m : methods) choices.emplace_back(m.name, m);
    add_choice<Method>(app, "--method", method, choices,
                       "Method of solving, see docs/method/method.md (default: ihsrr with a view, hsrr without)")
        ->group(solver_group);
}

void add_limits(CLI::App& app, GivenLimits& limits) {
    const auto group = [](CLI::Option* option) { option->group(limits_group); };
    group(add_parsed(app, "--rays", limits.rays, parse_count,
                     "Maximum number of rays, such as 20M (default 20M, unless --time or --until is given)")
              ->type_name("COUNT"));
    group(app.add_option(
                 "--time", limits.time,
                 "Maximum solving time, without reading, cutting and writing; in render: time of the whole command")
              ->type_name("SECONDS")
              ->check(number_between(1e-3, 1e9)));
    group(add_parsed(app, "--until", limits.until, parse_share,
                     "Stop at this estimated relative error, such as 2%; with a view: of its picture")
              ->type_name("SHARE"));
}

void SolverOptions::add_to(CLI::App& app) {
    add_method(app, given_.method);
    add_parsed(app, "--seed", given_.others.seed, parse_seed, "Same seed, same bits")
        ->type_name("NUMBER")
        ->default_str("1")
        ->group(solver_group);
    app.add_flag("--keep-direct", given_.others.keep_direct, "Store direct light separately in the solution file")
        ->group(solver_group);
    app.add_option("--stats", stats, "File for statistics of each iteration, as JSON lines")
        ->type_name("FILE")
        ->group(solver_group);
    add_limits(app, given_.limits);
    add_parsed(app, "--memory", memory, parse_memory,
               "Maximum memory of the process, where refinement ends (k, M, G: powers of 1024)")
        ->type_name("BYTES")
        ->default_str("9/10 of the machine's")
        ->group(limits_group);
    add_refinement(app);
    add_importance(app);
    add_schedule(app);
    add_paper_refinement(app);
    add_paper_importance(app);
    add_threads(app, threads);
}

void SolverOptions::add_refinement(CLI::App& app) {
    const auto group = [](CLI::Option* option) { option->group(refinement_group); };
    RefinementOptions& refinement = given_.others.refinement;
    group(add_choice<RefinementCriterion>(app, "--refinement-criterion", refinement.criterion,
                                          {{"variance", RefinementCriterion::variance},
                                           {"perceptual", RefinementCriterion::perceptual},
                                           {"power", RefinementCriterion::power}},
                                          "Split elements where rays measure differences, only where these are "
                                          "visible, or by the power between pairs "
                                          "(Eq. 14, 15)")
              ->default_str("variance"));
    group(app.add_option("--min-area", refinement.min_area,
                         "Minimum area of elements [m2]; 0: the area that a pixel shows of visible surfaces, elsewhere "
                         "(5 mm)2 or less")
              ->type_name("AREA")
              ->capture_default_str()
              ->check(number_between(0, 1e9)));
    group(add_parsed(app, "--max-elements", refinement.max_elements, parse_element_count,
                     "Maximum number of elements, where refinement ends")
              ->type_name("COUNT")
              ->default_str("67M"));
}

void SolverOptions::add_importance(CLI::App& app) {
    const auto group = [](CLI::Option* option) { option->group(importance_group); };
    group(add_choice<ImportanceUse>(
        app, "--importance", given_.importance,
        {{"off", ImportanceUse::off}, {"direct", ImportanceUse::direct}, {"full", ImportanceUse::full}},
        "Surfaces on which a view concentrates rays: off: none; direct: visible ones; full: also those that light them "
        "(default: of the method)"));
    ImportanceOptions& importance = given_.others.importance;
    group(app.add_option("--camera-rays", importance.camera_rays,
                         "Initial camera rays per view; their number grows with that of the averaged rays")
              ->capture_default_str()
              ->check(CLI::Range(1, max_camera_rays)));
    group(
        app.add_option("--importance-smoothing", importance.smoothing,
                       "Share of its parent's importance in the rays and refinement of an element; 0: as in the paper")
            ->type_name("SHARE")
            ->capture_default_str()
            ->check(number_between(0, 1)));
    group(app.add_option("--importance-exponent", importance.exponent,
                         "Rays are sampled by power times importance to this power; 1: as in the paper")
              ->type_name("EXPONENT")
              ->capture_default_str()
              ->check(number_between(0, 1)));
}

void SolverOptions::add_schedule(CLI::App& app) {
    const auto group = [](CLI::Option* option) { option->group(experimental_group); };
    ExperimentalOptions& o = given_.others.experimental;
    // This option takes effect while the command line is parsed, before the options that replace its settings.
    group(app.add_option_function<std::string>(
                 "--preset",
                 [this](const std::string&) {
                     use_published_algorithm(given_.others);
                     given_.is_published = true;
                 },
                 "paper: the algorithm as published in 2000, in 10 iterations that warm up and 100 that are averaged; "
                 "other options replace its settings")
              ->type_name("paper")
              ->check(CLI::IsMember({"paper"}))
              ->trigger_on_parse());
    group(add_choice<PointSet>(app, "--points", o.points, {{"sobol", PointSet::sobol}, {"random", PointSet::random}},
                               "Sample points: Owen-scrambled Sobol' or pseudo-random")
              ->default_str("sobol"));
    group(app.add_flag("--one-bounce", o.one_bounce,
                       "An iteration is one bounce of the running mean, not a pass over all bounces"));
    group(app.add_option("--warm-up", o.warm_up, "Iterations that are not averaged, after the first estimate")
              ->capture_default_str()
              ->check(CLI::Range(0, 1'000'000)));
    group(app.add_option("--iterations", o.iterations, "Number of averaged iterations; 0: until a limit is reached")
              ->capture_default_str()
              ->check(CLI::Range(0, 1'000'000'000)));
    group(add_parsed(app, "--rays-per-iteration", given_.rays_per_iteration, parse_iteration_size,
                     "Rays of each iteration; default: small at first, then growing")
              ->type_name("COUNT"));
}

void SolverOptions::add_paper_refinement(CLI::App& app) {
    const auto group = [](CLI::Option* option) { option->group(experimental_group); };
    ExperimentalOptions& o = given_.others.experimental;
    group(app.add_flag("--shrinkage,!--no-shrinkage", o.shrinkage,
                       "Reduce differences of neighbouring elements that are mostly noise "
                       "(with --refinement-criterion variance)"));
    group(app.add_flag("--clusters,!--no-clusters", o.clusters,
                       "Also between faces that are near each other and face alike: for scenes of many small faces. "
                       "Method hr: link clusters of faces where they are many"));
    group(app.add_option("--epsilon", o.epsilon,
                         "Maximum power between two undivided elements, relative to the visible (or emitted) power, "
                         "after 20M averaged rays")
              ->type_name("SHARE")
              ->capture_default_str()
              ->check(number_between(1e-15, 1e15)));
    group(
        app.add_option("--epsilon-decay", o.epsilon_decay,
                       "--epsilon falls as rays^-EXPONENT: the mesh gets finer as the noise falls; 0: as in the paper")
            ->type_name("EXPONENT")
            ->capture_default_str()
            ->check(number_between(0, 1)));
    group(app.add_option("--inherited-weight", o.inherited_weight,
                         "Weight of its parent's earlier rays in a new element; 1: as in the paper")
              ->type_name("SHARE")
              ->capture_default_str()
              ->check(number_between(0, 1)));
    group(app.add_flag("--defer-refinement", o.defer_refinement,
                       "No refinement during the warm-up ('dr', with --warm-up)"));
}

void SolverOptions::add_paper_importance(CLI::App& app) {
    const auto group = [](CLI::Option* option) { option->group(experimental_group); };
    ExperimentalOptions& o = given_.others.experimental;
    group(app.add_flag("--separate-iterations", o.separate_iterations,
                       "Importance and power in steps of their own ('si'), instead of in one ('ci')"));
    group(app.add_flag("--importance-at-patches", o.importance_at_patches,
                       "Store importance per patch, instead of per element ('hi')"));
    group(app.add_flag("--total-importance", o.total_importance,
                       "Sample rays by total importance (Eq. 9), instead of indirect (Eq. 10)"));
    group(app.add_option("--alpha", o.alpha, "Share of the rays for importance")
              ->type_name("SHARE")
              ->capture_default_str()
              ->check(number_between(0, 1)));
    group(app.add_option("--beta", o.beta, "Share of the other rays that are sampled by power alone")
              ->type_name("SHARE")
              ->capture_default_str()
              ->check(number_between(0, 1)));
}

SolveOptions SolverOptions::resolved(const std::vector<View>& views, float aspect, int pixel_rows) const {
    GivenSettings given = given_;
    for (const View& view : views) given.others.views.push_back({view, 1, aspect, pixel_rows});
    return interflect::resolved(given);
}

bool SolverOptions::method_refines(bool has_views) const {
    return given_.method.value_or(default_method(has_views)).refines;
}

}  // namespace interflect::command
