#include "interflect/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "interflect/core.h"
#include "interflect/generators/building/plan/floor_plan.h"
#include "interflect/generators/building/rooms/floor_space.h"
#include "interflect/generators/building/rooms/furnish.h"
#include "interflect/generators/building/rooms/room_views.h"
#include "interflect/generators/building/walls/shell.h"

namespace interflect {

using namespace detail;

namespace {

using namespace building;

constexpr float maze_luminaire_pitch = 100;  // wider than any room: one luminaire each [m]

/// Large pieces first, because later ones may not fit.
const std::array wall_furniture{&bookcase, &bookcase, &workstation, &workstation, &low_bookcase, &cabinet,
                                &radiator, &picture,  &picture,     &cartons,     &waste_bin};

void require_valid(const MazeOptions& options) {
    if (options.rooms < 1 || options.rooms > MazeOptions::max_rooms)
        throw InputError(fmt::format("a maze has 1 to {} rooms, not {}", MazeOptions::max_rooms, options.rooms));
    if (!(options.extra_doors >= 0 && options.extra_doors <= 1))
        throw InputError(fmt::format("the share of extra doors must be 0 to 1, not {}", options.extra_doors));
}

RandomSequence sequence_of(const MazeOptions& options, std::uint32_t room) {
    return RandomSequence(mix(options.seed, std::uint64_t{room} + 1));
}

void furnish(const FloorPlan& plan, const Room& room, const RoomView& room_view, Furnisher& furnisher,
             RandomSequence& random) {
    FloorSpace floor(plan, room);
    floor.reserve(room_view.standing_room);
    if (const auto place = floor.in_the_open(table, random)) furnisher.add(table, *place);
    for (const Furniture* piece : wall_furniture)
        if (const auto place = floor.against_wall(*piece, random)) furnisher.add(*piece, *place);
}

}  // namespace

Scene make_maze(const MazeOptions& options) {
    require_valid(options);
    const FloorPlan plan =
        make_floor_plan({.rooms = options.rooms, .extra_doors = options.extra_doors, .seed = options.seed});
    Scene scene;
    scene.name = fmt::format("maze of {} rooms", options.rooms);
    scene.objects.emplace_back();
    const Palette palette = add_palette(scene);

    std::vector<RandomSequence> random;
    std::vector<Finish> finishes;
    for (std::uint32_t i = 0; i < options.rooms; ++i) {
        random.push_back(sequence_of(options, i));
        finishes.push_back(draw_finish(palette, random.back()));
    }
    add_shell(scene, plan, finishes);

    for (std::uint32_t i = 0; i < options.rooms; ++i) {
        const Room& room = plan.rooms[i];
        Furnisher furnisher(scene, palette, i, random[i]);
        furnisher.add_luminaires(room, plan.room_height, maze_luminaire_pitch, random[i].chance(.5f));
        const RoomView room_view = building::room_view(plan, i);
        if (options.furniture) furnish(plan, room, room_view, furnisher, random[i]);
        if (i < max_room_views) scene.views.push_back(room_view.view);
    }
    scene.views.push_back(bird_view(plan));
    return scene;
}

std::uint32_t maze_rooms_for(std::uint64_t patches, const MazeOptions& options) {
    constexpr std::uint32_t sample = 64;  // enough for the mean
    MazeOptions small = options;
    small.rooms = sample;
    const double patches_per_room = static_cast<double>(make_maze(small).patches.size()) / sample;
    const double rooms = std::max(1.0, std::round(static_cast<double>(patches) / patches_per_room));
    if (rooms > MazeOptions::max_rooms)
        throw InputError(fmt::format("{} patches would need {:.0f} rooms of about {:.0f} patches; at most {} are made",
                                     patches, rooms, patches_per_room, MazeOptions::max_rooms));
    return static_cast<std::uint32_t>(rooms);
}

}  // namespace interflect
