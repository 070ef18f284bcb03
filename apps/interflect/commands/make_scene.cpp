#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <functional>
#include <memory>
#include <string>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/values/parse.h"
#include "interflect/core.h"
#include "interflect/formats/scene_files.h"
#include "interflect/generate.h"

namespace interflect::command {

using namespace detail;

namespace {

namespace fs = std::filesystem;

struct OutputOptions {
    fs::path path;
    bool force = false;  // whether to replace views and images that differ
};

/// Writes a scene with its views and textures. Opens the files before it makes the scene.
void write(const OutputOptions& output, const std::function<Scene()>& make) {
    const fs::path& path = output.path;
    if (path.extension() != ".mgf")
        throw UsageError("--output", fmt::format("scenes are written as .mgf, found '{}'", path.string()));
    SceneFiles files(path);
    const Scene scene = make();
    files.write(scene);
    if (const auto other = files.find_difference(); other && !output.force)
        throw InputError(
            other->file, 0,
            fmt::format("has other {} than the scene's: expected --force to replace them", other->content));
    files.commit();
    spdlog::info("{}: {} patches; {}: {} views", path.string(), scene.patches.size(), files.views().string(),
                 scene.views.size());
}

CLI::App& add_kind(CLI::App& parent, const std::string& name, const std::string& help,
                   const std::function<Scene()>& make) {
    const auto output = std::make_shared<OutputOptions>();
    CLI::App& kind = *parent.add_subcommand(name, help);
    kind.add_option("-o,--output", output->path, "Scene file to write (.mgf); its views go beside it (.views.json)")
        ->required();
    kind.add_flag("--force", output->force, "Replace a .views.json or an image that differs");
    kind.callback([output, make] { write(*output, make); });
    return kind;
}

CLI::App& add_kind(CLI::App& parent, const std::string& name, const std::string& help, std::uint64_t& seed,
                   const std::function<Scene()>& make) {
    CLI::App& kind = add_kind(parent, name, help, make);
    kind.add_option("--seed", seed, "Same seed, same scene")->capture_default_str();
    return kind;
}

CLI::Option* add_number(CLI::App& kind, const std::string& name, std::uint32_t& number, std::uint32_t most,
                        const std::string& help) {
    return kind.add_option(name, number, help)->capture_default_str()->check(CLI::Range(1u, most));
}

void add_maze(CLI::App& parent) {
    struct Options {
        MazeOptions maze;
        std::int64_t patches = 0;  // 0: determined by the rooms
    };
    const auto options = std::make_shared<Options>();
    MazeOptions& maze = options->maze;
    CLI::App& kind = add_kind(parent, "maze", "Rooms joined by doorways, a luminaire in each", maze.seed, [options] {
        MazeOptions asked_for = options->maze;
        if (options->patches > 0)
            asked_for.rooms = maze_rooms_for(static_cast<std::uint64_t>(options->patches), asked_for);
        return make_maze(asked_for);
    });
    CLI::Option* rooms = add_number(kind, "--rooms", maze.rooms, MazeOptions::max_rooms, "How many rooms");
    add_parsed(kind, "--patches", options->patches, parse_count,
               "About so many patches, such as 10M: chooses the number of rooms")
        ->excludes(rooms);
    kind.add_flag("--furniture", maze.furniture, "With desks, chairs, bookcases: about 2,600 patches a room, not 50");
    kind.add_option("--extra-doors", maze.extra_doors,
                    "Share of the walls that could stay closed which get a doorway as well")
        ->capture_default_str()
        ->check(CLI::Range(0.f, 1.f));
}

void add_office(CLI::App& parent) {
    const auto office = std::make_shared<OfficeOptions>();
    CLI::App& kind = add_kind(parent, "office", "Offices with desks in rows and luminaires in a grid", office->seed,
                              [office] { return make_office(*office); });
    add_number(kind, "--rooms", office->rooms, OfficeOptions::max_rooms, "How many rooms");
    add_number(kind, "--desk-rows", office->desk_rows, OfficeOptions::max_rows, "Rows of desks in a room");
    add_number(kind, "--desks-per-row", office->desks_per_row, OfficeOptions::max_desks_per_row, "Desks in a row");
}

void add_boxes(CLI::App& parent) {
    const auto boxes = std::make_shared<BoxesOptions>();
    CLI::App& kind = add_kind(parent, "boxes", "One room with random boxes on its floor", boxes->seed,
                              [boxes] { return make_boxes(*boxes); });
    add_number(kind, "--boxes", boxes->boxes, BoxesOptions::max_boxes, "How many boxes");
    kind.add_flag("--texture", boxes->texture,
                  "With images on the floor, the boxes and the luminaires, written beside the scene (.png)");
}

void add_two_rooms(CLI::App& parent) {
    const auto rooms = std::make_shared<TwoRoomsOptions>();
    CLI::App& kind = add_kind(parent, "two-rooms", "Two sealed rooms on one floor, one of them lit: to see light leak",
                              [rooms] { return make_two_rooms(*rooms); });
    kind.add_option("--turn", rooms->turn, "Turn of the wall between them [degrees]")
        ->capture_default_str()
        ->check(CLI::Range(-40.f, 40.f));
    kind.add_flag("--furniture", rooms->furniture, "With cabinets against that wall");
}

}  // namespace

void add_make_scene(CLI::App& app) {
    CLI::App& command = *app.add_subcommand("make-scene", "Make a scene of any size to measure on");
    command.require_subcommand(1);
    add_maze(command);
    add_office(command);
    add_boxes(command);
    add_two_rooms(command);
}

}  // namespace interflect::command
