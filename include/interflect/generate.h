/// @file
/// Scenes of any size for tests and measurements: mazes, offices, rooms of boxes, two sealed rooms.
#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect {

struct MazeOptions {
    static constexpr std::uint32_t max_rooms = 10'000;

    std::uint32_t rooms = 9;  ///< 1 to max_rooms.
    bool furniture = false;
    float extra_doors = 0.15f;  ///< Fraction of other walls with a doorway, 0 to 1.
    std::uint64_t seed = 1;
};

/// Creates a maze to test importance: views see small parts, most light is indirect. Rooms of 5 to 7 m form a nearly
/// square grid about the origin, z up, each with a luminaire of about 8,000 lm. Nine furnished rooms match the scene in
/// Prikryl et al. 2000 (23,182 patches). Views "overview" and, for the first 64 rooms, "room-0", ...
/// @throws InputError for options out of range.
Scene make_maze(const MazeOptions& options);

/// Returns the number of rooms with about `patches` patches in total; ignores options.rooms. @throws InputError above
/// max_rooms.
std::uint32_t maze_rooms_for(std::uint64_t patches, const MazeOptions& options);

struct OfficeOptions {
    static constexpr std::uint32_t max_rooms = 256, max_rows = 20, max_desks_per_row = 20;

    std::uint32_t rooms = 1;          ///< 1 to max_rooms.
    std::uint32_t desk_rows = 3;      ///< Per room, 1 to max_rows.
    std::uint32_t desks_per_row = 4;  ///< 1 to max_desks_per_row.
    std::uint64_t seed = 1;
};

/// Creates equal rooms with rows of desks, a grid of luminaires and furniture along walls; otherwise as make_maze().
/// @throws InputError for options out of range.
Scene make_office(const OfficeOptions& options);

struct BoxesOptions {
    static constexpr std::uint32_t max_boxes = 100'000;

    std::uint32_t boxes = 20;  ///< 1 to max_boxes.
    std::uint64_t seed = 1;
    bool texture = false;
};

/// Creates a closed, square room about the origin, 2.8 m high, with ceiling luminaires and a random box per 1.4 m^2 of
/// floor, at least 4 mm apart. Views "room-0" and "overview". @throws InputError for options out of range.
Scene make_boxes(const BoxesOptions& options);

struct TwoRoomsOptions {
    float turn = 0;          ///< Rotation of the partition about the vertical [degrees], -40 to 40.
    bool furniture = false;  ///< Whether to add two cabinets per side, and paper on a cabinet.
};

/// Creates two sealed rooms of 4 x 4 x 3 m with common floor, ceiling and outer wall polygons, which a rotated
/// partition penetrates. The only luminaire is in the first (x < 4): light in the second has leaked. Views "lit" and
/// "dark".
/// @throws InputError if the turn is out of range.
Scene make_two_rooms(const TwoRoomsOptions& options);

}  // namespace interflect
