#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/measure/measured_grid.h"
#include "apps/interflect/measure/measuring_places.h"
#include "apps/interflect/measure/probe_glare.h"
#include "apps/interflect/options/light_group_options.h"
#include "apps/interflect/options/refused_options.h"
#include "apps/interflect/options/shading_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/solving/read_light.h"
#include "apps/interflect/solving/run_solve.h"
#include "apps/interflect/solving/setup_warnings.h"
#include "apps/interflect/solving/stats_file.h"
#include "apps/interflect/values/csv_file.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/measure.h"

namespace interflect::command {

using namespace detail;

namespace {

enum class ProbedQuantity { surface, horizontal, vertical, cylindrical, semicylindrical, ugr };

struct ProbeArguments {
    SceneOptions scene;
    MeshOptions mesh;
    DimmingOptions dimming;
    SolverOptions solver;
    MeasuringPlaces places;
    ProbedQuantity quantity = ProbedQuantity::surface;
    std::vector<Imath::V3d> directions;
    std::vector<Observer> seats;
    MeasuringOptions measuring;
    std::optional<double> exterior;
    std::filesystem::path output;
    bool json = false;
};

bool needs_direction(ProbedQuantity quantity) {
    return quantity == ProbedQuantity::vertical || quantity == ProbedQuantity::semicylindrical;
}

const char* name_of(ProbedQuantity quantity) {
    switch (quantity) {
        case ProbedQuantity::surface:
            return "illuminance of the surface";
        case ProbedQuantity::horizontal:
            return "horizontal illuminance";
        case ProbedQuantity::vertical:
            return "vertical illuminance";
        case ProbedQuantity::cylindrical:
            return "cylindrical illuminance";
        case ProbedQuantity::semicylindrical:
            return "semicylindrical illuminance";
        case ProbedQuantity::ugr:
            return "UGR";
    }
    return "";
}

void check_direction(const ProbeArguments& options) {
    if (options.quantity == ProbedQuantity::ugr) {
        for (const Imath::V3d& d : options.directions)
            if (!(V3f(d).length() > 0)) throw UsageError("--direction 0,0,0 is no direction");
        return;
    }
    if (!needs_direction(options.quantity)) {
        if (!options.directions.empty())
            throw UsageError("--direction has no effect: it is for --quantity vertical, semicylindrical and ugr");
        return;
    }
    if (options.directions.size() != 1)
        throw UsageError("--quantity vertical and semicylindrical need one --direction X,Y,Z: the way that they face");
    if (!(std::hypot(options.directions[0].x, options.directions[0].y) > 0))
        throw UsageError("--direction: expected a direction that is not vertical (z)");
}

void check_exterior(const ProbeArguments& options) {
    if (options.exterior && options.quantity == ProbedQuantity::ugr)
        throw UsageError("--exterior", "it has no effect on glare (ugr)");
}

std::vector<V3f> lines_of_sight(const ProbeArguments& options) {
    if (options.directions.empty()) return usual_directions();
    return {options.directions.begin(), options.directions.end()};
}

void check_seats(const ProbeArguments& options) {
    if (!options.seats.empty() && options.quantity != ProbedQuantity::ugr)
        throw UsageError("--seat", "it has no effect without --quantity ugr");
}

MeasuringPoint measuring_point(const Imath::V3d& position, const MeasuringGrid& grid, const ProbeArguments& options) {
    V3f facing(0);
    if (!options.directions.empty()) facing = V3f(Imath::V3d(options.directions[0].x, options.directions[0].y, 0));
    switch (options.quantity) {
        case ProbedQuantity::surface:
            return {position, grid.normal};
        case ProbedQuantity::horizontal:
            return {position};
        case ProbedQuantity::vertical:
            return {position, facing};
        case ProbedQuantity::cylindrical:
            return {position, {}, Receiver::cylindrical};
        case ProbedQuantity::semicylindrical:
            return {position, facing, Receiver::semicylindrical};
        case ProbedQuantity::ugr:
            break;
    }
    return {};
}

std::vector<MeasuredGrid> measure(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                  std::vector<MeasuringGrid> grids, const ProbeArguments& options) {
    std::vector<MeasuringPoint> points;
    for (const MeasuringGrid& grid : grids)
        for (const Imath::V3d& position : grid.points) points.push_back(measuring_point(position, grid, options));
    return measure_grids(scene, solution, ray_caster, std::move(grids), points, options.measuring);
}

void write_csv(PendingFile& output, const std::vector<MeasuredGrid>& grids) {
    CsvFile file(output,
                 "x [m],y [m],z [m],E [lx],standard error [lx],solution error [lx],direct [lx],indirect [lx],area");
    for (const MeasuredGrid& g : grids)
        for (std::size_t i = 0; i < g.measured.size(); ++i) {
            const MeasuredIrradiance& e = g.measured[i];
            const Imath::V3d& p = g.grid.points[i];
            const double of_solution = g.solution_error.at(e);  // unknown after an interruption
            file.add_line(fmt::format("{:.10g},{:.10g},{:.10g},{:.6g},{:.3g},{},{:.6g},{:.6g},{}", p.x, p.y, p.z,
                                      e.illuminance(), e.illuminance_error(),
                                      std::isfinite(of_solution) ? fmt::format("{:.3g}", of_solution) : "",
                                      luminance(e.direct), luminance(e.indirect), csv_field(g.grid.name)));
        }
    file.commit();
}

std::string text_of_errors(double of_sampling, double of_solution) {
    return fmt::format("standard error {:.2g} lx of sampling, {} of the solution", of_sampling,
                       std::isfinite(of_solution) ? fmt::format("{:.2g} lx", of_solution) : "unknown");
}

void print_text(const MeasuredGrid& g, const IlluminanceSummary& s, const ProbeArguments& options,
                const std::optional<double>& exterior) {
    print_line("{}: {}", g.grid.name, text_of(g.grid));
    print_line("  {}", name_of(options.quantity));
    if (g.missing > 0)
        print_line("  interrupted       {} of {} points were not measured", g.missing, g.missing + g.measured.size());
    if (g.measured.empty()) return;
    print_line("  mean              {:.4g} lx, {}", s.mean, text_of_errors(s.mean_error, s.mean_solution_error));
    print_line("  minimum           {:.4g} lx, {}", s.min, text_of_errors(s.min_error, s.min_solution_error));
    print_line("  maximum           {:.4g} lx", s.max);
    print_line("  Emin/Emean (U0)   {:.3f}", s.uniformity());
    print_line("  Emin/Emax         {:.3f}", s.diversity());
    if (exterior)
        print_line("  daylight factor   mean {:.3g}%, minimum {:.3g}%, maximum {:.3g}%, of {:.4g} lx outside",
                   100 * s.mean / *exterior, 100 * s.min / *exterior, 100 * s.max / *exterior, *exterior);
}

Json to_json(const MeasuredGrid& g, const IlluminanceSummary& s, const ProbeArguments& options,
             const std::optional<double>& exterior) {
    Json json{{"name", g.grid.name},
              {"quantity", name_of(options.quantity)},
              {"points", s.points},
              {"missing", g.missing},
              {"enclosed", g.grid.enclosed},
              {"columns", g.grid.columns},
              {"rows", g.grid.rows},
              {"spacing", {g.grid.column_spacing, g.grid.row_spacing}},
              {"mean", s.mean},
              {"standard_error", s.mean_error},
              {"min", s.min},
              {"max", s.max},
              {"uniformity", s.uniformity()},
              {"diversity", s.diversity()}};
    if (std::isfinite(s.mean_solution_error)) json["solution_error"] = s.mean_solution_error;
    if (exterior) json["daylight_factor"] = s.mean / *exterior;
    return json;
}

void print_summaries(const Scene& scene, const std::vector<MeasuredGrid>& grids, const ProbeArguments& options) {
    const std::optional<double> exterior = exterior_of(scene, options.exterior);
    Json areas = Json::array();
    for (const MeasuredGrid& g : grids) {
        const IlluminanceSummary summary = summarise(g.measured, g.solution_error);
        if (options.json)
            areas.push_back(to_json(g, summary, options, exterior));
        else
            print_text(g, summary, options, exterior);
    }
    if (options.json) std::cout << json_text({{"interrupted", is_stop_requested()}, {"areas", areas}}, 2) << '\n';
}

void measure_and_write(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                       std::vector<MeasuringGrid> grids, const ProbeArguments& options,
                       std::optional<PendingFile>& output) {
    if (options.quantity == ProbedQuantity::ugr) {
        const std::vector<RatedGrid> rated = rate_places(
            scene, solution, ray_caster, {std::move(grids), options.seats, lines_of_sight(options)}, options.measuring);
        if (output) write_ratings(*output, rated);
        print_ratings(rated, options.json);
    } else {
        const std::vector<MeasuredGrid> measured = measure(scene, solution, ray_caster, std::move(grids), options);
        if (output) write_csv(*output, measured);
        print_summaries(scene, measured, options);
    }
}

void run(ProbeArguments& options, const CLI::App& command, int& exit_code) {
    // Check all options before long work.
    const ThreadLimit threads(options.solver.threads);
    options.measuring.samples =
        require_samples(options.measuring.shading, &DefaultSamples::point, options.measuring.samples);
    const bool uses_solution = needs_solution(options.measuring.shading);
    if (!uses_solution) refuse_solver_options(command);
    PathTracerArguments::check_samples(command, options.measuring.samples);
    options.scene.check(command, true);
    options.dimming.require_solution(options.scene.path);
    options.places.check(options.seats.empty() ? MeasuringPlaces::Least::one : MeasuringPlaces::Least::none);
    check_direction(options);
    check_seats(options);
    check_exterior(options);
    const std::array<NamedFile, 2> outputs{{{"--output", options.output}, {"--stats", options.solver.stats}}};
    require_distinct_files(input_files(options.scene, {}), outputs);
    for (const NamedFile& output : outputs) require_text_name(output);
    std::optional<PendingFile> output;
    if (!options.output.empty()) output.emplace(options.output);

    // Read the solution, or read the scene and cut or divide it.
    const bool solved_before = is_solution_file(options.scene.path);
    SolvedScene solved = read_scene_or_solution(options.scene, options.dimming);
    refuse_overwriting(solved.scene, outputs);
    std::vector<MeasuringGrid> grids = options.places.grids(solved.scene);
    const bool solves = !solved_before && uses_solution;
    const SolveOptions solve_options = options.solver.resolved({});
    if (solves)
        solved.scene = options.mesh.divide(std::move(solved.scene), options.scene.read, solve_options.method.refines);
    else if (!solved_before)
        solved.scene = options.mesh.cut(std::move(solved.scene), options.scene.read);

    // Solve it if light is gathered from the solution.
    StatsFile stats(options.solver.threads, options.solver.stats);
    const RayCaster ray_caster = make_ray_caster(solved.scene);
    grids = open_grids(solved.scene, ray_caster, std::move(grids));
    warn_of_setup(solved.scene, ray_caster);
    if (solves) solved.solution = run_solve(solved.scene, ray_caster, solve_options, options.solver.memory);

    // Measure. A signal now ends the measurement early.
    options.measuring.until = options.solver.until();
    options.measuring.seed = options.solver.seed();
    stop_on_signal();
    const Solution* solution = uses_solution ? &solved.solution : nullptr;
    try {
        measure_and_write(solved.scene, solution, ray_caster, std::move(grids), options, output);
    } catch (const Stopped& e) {
        spdlog::warn("{}: nothing is written", e.what());
    }
    if (solves) stats.write(solved.scene, solved.solution);
    if (is_stop_requested()) exit_code = interrupted;
}

void add_quantity(CLI::App& command, ProbeArguments& options) {
    add_choice<ProbedQuantity>(command, "--quantity", options.quantity,
                               {{"surface", ProbedQuantity::surface},
                                {"horizontal", ProbedQuantity::horizontal},
                                {"vertical", ProbedQuantity::vertical},
                                {"cylindrical", ProbedQuantity::cylindrical},
                                {"semicylindrical", ProbedQuantity::semicylindrical},
                                {"ugr", ProbedQuantity::ugr}},
                               "Illuminance: of the surface that a grid lies on (of points and lines horizontal), "
                               "horizontal, of a vertical plane, of a cylinder or of half of one; or glare, by UGR")
        ->default_str("surface");
    add_each(command, "--direction", options.directions, parse_vector,
             "The way that a vertical plane, half a cylinder or an observer faces (for ugr may be repeated; default: "
             "x, -x, y and -y)")
        ->type_name("X,Y,Z");
    add_seats(command, options.seats);
    command
        .add_option("--exterior", options.exterior,
                    "Horizontal illuminance outside [lx], for daylight factors (default: from the scene's sky)")
        ->type_name("LUX")
        ->check(number_between(1e-12, 1e12));
}

}  // namespace

void add_probe(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<ProbeArguments>();
    CLI::App& command = *app.add_subcommand("probe", "Measure illuminance or glare at points and on grids");
    options->scene.add_to(command, std::string(scene_formats) + ", solved first, or solution file (.h5)");
    command.add_option("-o,--output", options->output, "Table of the points to write (.csv)")->type_name("FILE");
    command.add_flag("--json", options->json, "The summary as JSON on stdout");
    options->places.add_to(command);
    add_quantity(command, *options);
    command
        .add_option("--samples", options->measuring.samples,
                    fmt::format("Paths a point (default: {})", text_of_default_samples(&DefaultSamples::point)))
        ->check(CLI::Range(2, 1 << 24));
    command.add_option("--max-samples", options->measuring.max_samples, "Most paths a point with --until")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 24))
        ->group(path_group);
    add_shading(command, options->measuring.shading, &DefaultSamples::point, "point");
    options->dimming.add_to(command);
    options->solver.add_to(command);
    options->mesh.add_to(command);
    command.callback([options, &command, &exit_code] { run(*options, command, exit_code); });
}

}  // namespace interflect::command
