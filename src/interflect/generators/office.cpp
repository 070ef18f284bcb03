#include "interflect/generate.h"

#include <fmt/format.h>

#include <vector>

#include "interflect/core.h"
#include "interflect/generators/building/rooms/floor_space.h"
#include "interflect/generators/building/rooms/furnish.h"
#include "interflect/generators/building/rooms/room_views.h"
#include "interflect/generators/building/walls/shell.h"

namespace interflect {

using namespace detail;

namespace {

using namespace building;

constexpr float aisle = 1.5f;                         // between desks and walls [m]
constexpr float desk_pitch = 1.7f, row_pitch = 2.2f;  // [m]
constexpr float office_luminaire_pitch = 2.6f;        // [m]
constexpr float share_of_extra_doors = 0.3f;

void require_valid(const OfficeOptions& options) {
    const auto require = [](std::uint32_t value, std::uint32_t most, const char* what) {
        if (value < 1 || value > most)
            throw InputError(fmt::format("an office has 1 to {} {}, not {}", most, what, value));
    };
    require(options.rooms, OfficeOptions::max_rooms, "rooms");
    require(options.desk_rows, OfficeOptions::max_rows, "rows of desks in a room");
    require(options.desks_per_row, OfficeOptions::max_desks_per_row, "desks in a row");
}

FloorPlan plan_office(const OfficeOptions& options) {
    const float width = 2 * aisle + desk_pitch * static_cast<float>(options.desks_per_row);
    const float depth = 2 * aisle + row_pitch * static_cast<float>(options.desk_rows);
    return make_floor_plan({.rooms = options.rooms,
                            .width = {width, width},
                            .depth = {depth, depth},
                            .extra_doors = share_of_extra_doors,
                            .seed = options.seed});
}

void add_desks(const Room& room, const OfficeOptions& options, Furnisher& furnisher) {
    for (std::uint32_t row = 0; row < options.desk_rows; ++row)
        for (std::uint32_t desk = 0; desk < options.desks_per_row; ++desk)
            furnisher.add(workstation,
                          Placement::quarter_turned({room.x.low + aisle + desk_pitch * (static_cast<float>(desk) + .5f),
                                                     room.y.low + aisle + row_pitch * static_cast<float>(row), 0},
                                                    0));
}

std::vector<const Furniture*> furniture_along_walls(std::uint32_t desk_rows) {
    std::vector<const Furniture*> pieces;
    for (std::uint32_t row = 0; row < desk_rows; ++row) {
        pieces.push_back(row % 2 == 0 ? &bookcase : &cabinet);
        pieces.push_back(row % 2 == 0 ? &radiator : &low_bookcase);
    }
    pieces.insert(pieces.end(), {&picture, &picture, &cartons, &waste_bin});
    return pieces;
}

}  // namespace

Scene make_office(const OfficeOptions& options) {
    require_valid(options);
    const FloorPlan plan = plan_office(options);
    Scene scene;
    scene.name = fmt::format("office of {} rooms", options.rooms);
    scene.objects.emplace_back();
    const Palette palette = add_palette(scene);
    RandomSequence random(mix(options.seed, 1));
    std::vector<Finish> finishes;
    for (std::uint32_t i = 0; i < options.rooms; ++i) finishes.push_back(draw_finish(palette, random));
    add_shell(scene, plan, finishes);

    for (std::uint32_t i = 0; i < options.rooms; ++i) {
        const Room& room = plan.rooms[i];
        const RoomView room_view = building::room_view(plan, i);
        Furnisher furnisher(scene, palette, i, random);
        furnisher.add_luminaires(room, plan.room_height, office_luminaire_pitch, false);
        add_desks(room, options, furnisher);
        FloorSpace floor(plan, room);
        floor.reserve(room_view.standing_room);
        for (const Furniture* piece : furniture_along_walls(options.desk_rows))
            if (const auto place = floor.against_wall(*piece, random)) furnisher.add(*piece, *place);
        if (i < max_room_views) scene.views.push_back(room_view.view);
    }
    scene.views.push_back(bird_view(plan));
    return scene;
}

}  // namespace interflect
