#include "apps/interflect/shared_options.h"

#include <spdlog/spdlog.h>

#include <cmath>

#include "interflect/image/camera.h"
#include "interflect/scene/split.h"
#include "interflect/scene/view.h"

namespace interflect::command {

void SceneOptions::add_to(CLI::App& app, const std::string& what) {
    app.add_option("SCENE", path, what)->required()->type_name("FILE");
    app.add_option("--curve-divisions", read.curve_divisions, "Flat pieces per quarter circle of curved surfaces")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    add_parsed(app, "--max-patches", read.max_patches, parse_count,
               "Refuse a scene of more patches (files can ask for any number)")
        ->type_name("COUNT")
        ->default_str("50M");
}

Scene SceneOptions::load() const {
    Scene scene = load_scene(path, read);
    log_warnings(scene.warnings);
    return scene;
}

void log_warnings(const Warnings& warnings) {
    for (const Warnings::Entry& w : warnings.entries()) {
        const std::string times = w.count > 1 ? fmt::format(" ({} times)", w.count) : "";
        spdlog::warn("{}{}{}", w.where.empty() ? "" : w.where + ": ", w.message, times);
    }
}

void MeshOptions::add_to(CLI::App& app) {
    add_parsed(app, "--mesh-size", size, parse_mesh_size,
               "Longest edge of the mesh [m]; auto: from the scene's size; none: as in the file")
        ->type_name("METRES|auto|none")
        ->default_str("auto")
        ->group("Solver");
}

Scene MeshOptions::divide(Scene scene, const ReadOptions& read) const {
    if (size == whole_patches) return scene;
    const float edge = size == automatic_mesh_size ? default_mesh_size(scene) : size;
    return split_patches(scene, edge, read.max_patches);
}

void ViewOptions::add_to(CLI::App& app) {
    const auto group = [](CLI::Option* option) {
        option->group("View");
        return option;
    };
    group(app.add_option("--view", names, "Name of a view that the scene has (may be repeated)")->type_name("NAME"));
    group(app.add_option("--view-file", files, "Radiance view file, .vf (may be repeated)")->type_name("FILE"));
    const auto vector_option = [&](const std::string& name, auto& v, const std::string& help) {
        return group(add_parsed(app, name, v, parse_vector, help)->type_name("X,Y,Z"));
    };
    CLI::Option* eye_option = vector_option("--eye", eye, "Where the eye is [m]");
    CLI::Option* look_at_option = vector_option("--look-at", look_at, "A point in the middle of the picture [m]");
    eye_option->needs(look_at_option);
    look_at_option->needs(eye_option);
    vector_option("--up", up, "What is up in the picture")->default_str("0,0,1");
    group(app.add_option("--fov", fov, "Vertical field of view of --eye [degrees]")
              ->capture_default_str()
              ->check(number_between(0.001, 179)));
}

std::vector<View> ViewOptions::views(const Scene& scene) const {
    std::vector<View> views;
    for (const std::string& name : names) views.push_back(find_view(scene, name));
    for (const auto& file : files) views.push_back(read_radiance_view(file));
    if (eye) views.push_back({"command line", *eye, *look_at, up, fov});
    for (const View& view : views) Camera(view, 1, 1);  // refuses what defines no picture
    return views;
}

void add_threads(CLI::App& app, int& threads) {
    app.add_option("--threads", threads, "Threads to use; 0: as many as the machine has. Results do not depend on it")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096));
}

void SolverOptions::add_to(CLI::App& app) {
    const auto group = [](CLI::Option* option) {
        option->group("Solver");
        return option;
    };
    group(add_choice<std::string>(app, "--method", method, {{"srr", "srr"}}, "srr: stochastic ray radiosity, flat")
              ->default_str("srr"));
    rays_ = group(add_parsed(app, "--rays", solve.rays, parse_count,
                             "Most rays to trace, such as 20M (default 20M, unless --time or --until is given)")
                      ->type_name("COUNT"));
    group(app.add_option("--time", solve.seconds, "Most seconds to take")
              ->type_name("SECONDS")
              ->check(number_between(1e-3, 1e9)));
    group(add_parsed(app, "--until", solve.until, parse_share, "Stop at this estimated relative error, such as 2%")
              ->type_name("SHARE"));
    group(add_parsed(app, "--seed", solve.seed, parse_seed, "Same seed, same bits")
              ->type_name("NUMBER")
              ->default_str("1"));
    group(add_choice<PointSet>(app, "--points", solve.points,
                               {{"sobol", PointSet::sobol}, {"random", PointSet::random}},
                               "Sample points: scrambled Sobol' or pseudo-random")
              ->default_str("sobol"));
    group(app.add_option("--warm-up", solve.warm_up, "Iterations that are not averaged, after the first estimate")
              ->capture_default_str()
              ->check(CLI::Range(0, 1'000'000)));
    group(app.add_option("--iterations", solve.iterations, "Averaged iterations; 0: as many as the limits allow")
              ->capture_default_str()
              ->check(CLI::Range(0, 1'000'000'000)));
    group(add_parsed(app, "--rays-per-iteration", solve.rays_per_iteration, parse_count,
                     "Rays of each iteration; default: small at first, then growing")
              ->type_name("COUNT"));
    group(app.add_flag("--incremental-start,!--no-incremental-start", solve.incremental_start,
                       "First estimate by following the light bounce by bounce (default), or from darkness"));
    group(app.add_option("--stats", stats, "Write what each iteration did to this file, as JSON lines")
              ->type_name("FILE"));
    add_threads(app, threads);
}

SolveOptions SolverOptions::resolved() const {
    SolveOptions options = solve;
    const bool other_limit = std::isfinite(options.seconds) || options.until > 0;
    if (other_limit && rays_->count() == 0) options.rays = std::numeric_limits<std::int64_t>::max();
    return options;
}

}  // namespace interflect::command
