#include "apps/interflect/shared_options.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <map>

#include "apps/interflect/parse.h"
#include "interflect/scene/split.h"
#include "interflect/scene/view.h"

namespace interflect::command {

void SceneOptions::add_to(CLI::App& app, const std::string& what) {
    app.add_option("SCENE", path, what)->required();
    app.add_option("--curve-divisions", read.curve_divisions, "Flat pieces per quarter circle of curved surfaces")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app.add_option_function<std::string>(
           "--max-patches",
           [this](const std::string& text) { read.max_patches = static_cast<std::uint64_t>(parse_count(text)); },
           "Refuse a scene of more patches (files can ask for any number)")
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
    const auto check = [](const std::string& text) {
        if (text == "auto" || text == "none") return std::string();
        float number = 0;
        return CLI::detail::lexical_cast(text, number) && number > 0 && std::isfinite(number)
                   ? std::string()
                   : std::string("expected a length in metres, auto or none");
    };
    app.add_option("--mesh-size", size,
                   "Longest edge of the mesh [m]; auto: from the scene's size; none: as in the file")
        ->capture_default_str()
        ->check(CLI::Validator(check, "METRES|auto|none"))
        ->group("Solver");
}

Scene MeshOptions::divide(Scene scene, const ReadOptions& read) const {
    if (size == "none") return scene;
    const float edge = size == "auto" ? default_mesh_size(scene) : std::stof(size);
    return split_patches(scene, edge, read.max_patches);
}

void ViewOptions::add_to(CLI::App& app) {
    const auto group = [](CLI::Option* option) { option->group("View"); };
    group(app.add_option("--view", names, "Name of a view that the scene has (may be repeated)"));
    group(app.add_option("--view-file", files, "Radiance view file, .vf (may be repeated)"));
    const auto vector_option = [&](const std::string& name, std::optional<V3f>& v, const std::string& help) {
        CLI::Option* option = app.add_option_function<std::string>(
            name, [&v](const std::string& text) { v = parse_vector(text); }, help);
        option->group("View")->type_name("X,Y,Z");
        return option;
    };
    CLI::Option* eye_option = vector_option("--eye", eye, "Where the eye is [m]");
    CLI::Option* look_at_option = vector_option("--look-at", look_at, "A point in the middle of the picture [m]");
    eye_option->needs(look_at_option);
    look_at_option->needs(eye_option);
    group(add_parsed(app, "--up", up, parse_vector, "What is up in the picture (default 0,0,1)")->type_name("X,Y,Z"));
    group(app.add_option("--fov", fov, "Vertical field of view of --eye [degrees]")
              ->capture_default_str()
              ->check(CLI::Range(0.001, 179.0)));
}

std::vector<View> ViewOptions::views(const Scene& scene) const {
    std::vector<View> views;
    for (const std::string& name : names) views.push_back(find_view(scene, name));
    for (const auto& file : files) views.push_back(read_radiance_view(file));
    if (eye) views.push_back({"command line", *eye, *look_at, up, fov});
    return views;
}

void add_threads(CLI::App& app, int& threads) {
    app.add_option("--threads", threads, "Threads to use; 0: as many as the machine has. Results do not depend on it")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096));
}

void SolverOptions::add_to(CLI::App& app) {
    static const std::map<std::string, PointSet> point_sets{{"sobol", PointSet::sobol}, {"random", PointSet::random}};
    const auto group = [](CLI::Option* option) {
        option->group("Solver");
        return option;
    };
    group(app.add_option("--method", method, "srr: stochastic ray radiosity, flat")
              ->capture_default_str()
              ->check(CLI::IsMember({"srr"})));
    rays_ = group(add_parsed(app, "--rays", solve.rays, parse_count,
                             "Most rays to trace, such as 20M (default 20M, unless --time or --until is given)"));
    group(app.add_option("--time", solve.seconds, "Most seconds to take")->check(CLI::PositiveNumber));
    group(add_parsed(app, "--until", solve.until, parse_share, "Stop at this estimated relative error, such as 2%"));
    group(app.add_option("--seed", solve.seed, "Same seed, same bits")->capture_default_str());
    group(app.add_option("--points", solve.points, "Sample points: sobol (scrambled Sobol') or random")
              ->transform(CLI::CheckedTransformer(point_sets, CLI::ignore_case))
              ->default_str("sobol"));
    group(app.add_option("--warm-up", solve.warm_up, "Iterations that are not averaged, after the first estimate")
              ->capture_default_str()
              ->check(CLI::Range(0, 1'000'000)));
    group(app.add_option("--iterations", solve.iterations, "Averaged iterations; 0: as many as the limits allow")
              ->capture_default_str()
              ->check(CLI::Range(0, 1'000'000'000)));
    group(add_parsed(app, "--rays-per-iteration", solve.rays_per_iteration, parse_count,
                     "Rays of each iteration; default: small at first, then growing"));
    group(app.add_flag("--incremental-start,!--no-incremental-start", solve.incremental_start,
                       "First estimate by following the light bounce by bounce (default), or from darkness"));
    group(app.add_option("--stats", stats, "Write what each iteration did to this file, as JSON lines"));
    add_threads(app, threads);
}

SolveOptions SolverOptions::resolved() const {
    SolveOptions options = solve;
    const bool other_limit = std::isfinite(options.seconds) || options.until > 0;
    if (other_limit && rays_->count() == 0) options.rays = std::numeric_limits<std::int64_t>::max();
    return options;
}

}  // namespace interflect::command
