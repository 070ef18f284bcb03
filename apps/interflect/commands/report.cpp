#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <memory>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/path_progress.h"
#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/measure/measuring_places.h"
#include "apps/interflect/options/false_colour_options.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/long_work.h"
#include "apps/interflect/processes/threads.h"
#include "apps/interflect/report/page.h"
#include "apps/interflect/solving/read_light.h"
#include "apps/interflect/solving/setup_warnings.h"
#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/denoise.h"
#include "interflect/image.h"
#include "interflect/prepare.h"
#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::command {

using namespace detail;

namespace {

struct ReportArguments {
    std::filesystem::path solution, output;
    std::string title, date;
    double working_plane = 0.75;  // z [m]
    MeasuringPlaces places;
    std::optional<double> exterior;
    bool ugr = false;
    std::vector<Observer> seats;
    double eye_height = 1.2;  // z of the eyes of seated observers [m]
    ViewOptions view;
    Size size{640, 360};
    int samples = require_samples(Shading::gather, &DefaultSamples::point);
    std::uint64_t seed = 1;
    int threads = 0;
};

/// Returns the floors of objects, except those below 1% of the area, such as doorsteps.
std::vector<PlanarArea> rooms_of(const Scene& scene, const PlanarArea& floor) {
    constexpr double min_share = 0.01;
    std::vector<PlanarArea> rooms = divide_by_object(scene, floor);
    std::erase_if(rooms, [&](const PlanarArea& room) { return room.area < min_share * floor.area; });
    return rooms;
}

std::vector<MeasuringGrid> room_grids(const Scene& scene, const RayCaster& ray_caster,
                                      const std::vector<PlanarArea>& rooms, const ReportArguments& options,
                                      double height) {
    std::vector<MeasuringGrid> grids;
    for (const PlanarArea& room : rooms) {
        grids.push_back(area_grid(scene, room, options.places.grid.options(), height));
        grids.back().name += fmt::format(", z = {:.3g} m", height);
    }
    return open_grids(scene, ray_caster, std::move(grids));
}

/// Measures first the working planes of rooms, then other places.
std::vector<MeasuredGrid> measure_areas(const SolvedScene& solved, const RayCaster& ray_caster,
                                        const std::vector<PlanarArea>& rooms, const ReportArguments& options) {
    std::vector<MeasuringGrid> grids = room_grids(solved.scene, ray_caster, rooms, options, options.working_plane);
    for (MeasuringGrid& grid : open_grids(solved.scene, ray_caster, options.places.grids(solved.scene)))
        grids.push_back(std::move(grid));
    std::vector<MeasuringPoint> points;
    for (const MeasuringGrid& grid : grids)
        for (const Imath::V3d& p : grid.points) points.push_back({p, grid.normal});
    return measure_grids(solved.scene, &solved.solution, ray_caster, std::move(grids), points,
                         {.samples = options.samples, .seed = options.seed});
}

std::vector<RatedGrid> rate_rooms(const SolvedScene& solved, const RayCaster& ray_caster,
                                  const std::vector<PlanarArea>& rooms, const ReportArguments& options) {
    GlarePlaces places{{}, options.seats, usual_directions()};
    if (options.ugr) places.grids = room_grids(solved.scene, ray_caster, rooms, options, options.eye_height);
    return rate_places(solved.scene, &solved.solution, ray_caster, places,
                       {.samples = options.samples, .seed = options.seed});
}

ReportPicture draw_view(const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                        const ReportArguments& options) {
    PictureOptions picture{.width = options.size.width, .height = options.size.height, .seed = options.seed};
    const auto draw = [&] {
        Image image;
        with_path_progress([&](const Monitor& monitor) {
            image = denoise(render(solved.scene, solved.solution, ray_caster, view, picture, monitor).layers).image;
        });
        return image;
    };
    const Image light = draw();
    picture.quantity = PictureQuantity::irradiance;
    FalseColourOptions colours;
    colours.measured = Measured::illuminance;
    return {view.name, tone_map(light, automatic_exposure(light)), colours.draw(luminances(draw()), true)};
}

/// Returns the requested views, else the views of the scene, else an overview.
std::vector<View> views_to_draw(const Scene& scene, const RayCaster& ray_caster, const ReportArguments& options) {
    constexpr std::size_t most = 4;
    std::vector<View> views = options.view.views(scene);
    if (!views.empty()) return views;
    views = scene.views;
    if (views.empty()) return {overview(scene, ray_caster)};
    if (views.size() > most) {
        spdlog::info("{} of {} views are drawn (--view chooses others)", most, views.size());
        views.resize(most);
    }
    return views;
}

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::now())); }

ReportContent make_content(const SolvedScene& solved, const RayCaster& ray_caster, const std::vector<View>& views,
                           const ReportArguments& options) {
    const PlanarArea floor = find_floor(solved.scene, options.working_plane);
    ReportContent content;
    content.title = options.title.empty() ? std::filesystem::path(solved.scene.name).stem().string() : options.title;
    content.date = options.date.empty() ? today() : options.date;
    content.working_plane = options.working_plane;
    content.samples = options.samples;
    content.picture_samples = require_samples(PictureOptions().shading, &DefaultSamples::pixel);
    content.rooms = rooms_of(solved.scene, floor);
    content.exterior = exterior_of(solved.scene, options.exterior);
    content.areas = measure_areas(solved, ray_caster, content.rooms, options);
    if (options.ugr || !options.seats.empty()) content.glare = rate_rooms(solved, ray_caster, content.rooms, options);
    content.facts = facts_of(solved, ray_caster);
    const int plan_samples = std::max(2, options.samples / 4);  // few samples suffice, because isolines are smoothed
    content.plan = draw_plan(solved.scene, solved.solution, ray_caster, floor, options.working_plane,
                             {.samples = plan_samples, .seed = options.seed});
    for (const View& view : views) content.pictures.push_back(draw_view(solved, ray_caster, view, options));
    return content;
}

/// Writes a report. A signal ends the command without output, since half a report is useless.
void run(const ReportArguments& options) {
    const ThreadLimit threads(options.threads);
    const std::string extension = lower_case_extension(options.output);
    if (extension != ".html" && extension != ".htm")
        throw UsageError("--output", fmt::format("a report is HTML: expected a name that ends in .html, found '{}'",
                                                 options.output.string()));
    options.places.check(MeasuringPlaces::Least::none);
    options.view.check();
    require_distinct_files(std::array<NamedFile, 1>{{{"SOLUTION", options.solution}}},
                           std::array<NamedFile, 1>{{{"--output", options.output}}});
    require_memory_for_paths(options.size);
    PendingFile output(options.output);
    const SolvedScene solved = read_light_of(options.solution);
    const RayCaster ray_caster = make_ray_caster(solved.scene);
    const std::vector<View> views = views_to_draw(solved.scene, ray_caster, options);
    warn_of_setup(solved.scene, ray_caster);
    const ReportContent content = make_content(solved, ray_caster, views, options);
    output.write(report_page(content, solved));
    output.commit();
    spdlog::info("{}: {} measuring areas, {} views", options.output.string(), content.areas.size(),
                 content.pictures.size());
}

}  // namespace

void add_report(CLI::App& app) {
    const auto options = std::make_shared<ReportArguments>();
    CLI::App& command = *app.add_subcommand("report", "Write a lighting designer's report, as one HTML page");
    command.add_option("SOLUTION", options->solution, "Solution file (.h5)")->required()->type_name("FILE");
    command.add_option("-o,--output", options->output, "Page to write (.html)")->required()->type_name("FILE");
    command.add_option("--title", options->title, "Heading (default: the scene's name)")->type_name("TEXT");
    command.add_option("--date", options->date, "Date on the page (default: today)")->type_name("TEXT");
    command.add_option("--working-plane", options->working_plane, "Height z of the plan and the rooms' grids [m]")
        ->capture_default_str()
        ->type_name("HEIGHT")
        ->check(number_between(-1e15, 1e15));
    command.add_option("--exterior", options->exterior, "Horizontal illuminance outside [lx], for daylight factors")
        ->type_name("LUX")
        ->check(number_between(1e-12, 1e12));
    CLI::Option* const ugr = command.add_flag(
        "--ugr", options->ugr, "Rate glare for observers on a grid over each room, looking along x and y");
    command.add_option("--eye-height", options->eye_height, "Height z of these observers' eyes [m]")
        ->needs(ugr)
        ->capture_default_str()
        ->type_name("HEIGHT")
        ->check(number_between(-1e15, 1e15));
    add_seats(command, options->seats);
    options->places.whole_objects = true;  // because desks have no walls
    options->places.add_to(command);
    options->view.add_to(command);
    add_parsed(command, "--size", options->size, parse_size, "Size of the pictures in pixels")
        ->type_name("WxH")
        ->default_str("640x360");
    command.add_option("--samples", options->samples, "Paths a measuring point")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 24));
    add_parsed(command, "--seed", options->seed, parse_seed, "Same seed, same bits")
        ->type_name("NUMBER")
        ->default_str("1");
    add_threads(command, options->threads);
    command.callback([options] { run(*options); });
}

}  // namespace interflect::command
