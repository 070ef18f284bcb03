#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

/// What a maze is like.
struct MazeOptions {
    static constexpr std::uint32_t most_rooms = 10'000;

    std::uint32_t rooms = 9;    ///< 1 to most_rooms.
    bool furniture = false;     ///< Bookcases, desks, chairs, tables and so on; else the rooms are empty.
    float extra_doors = 0.15f;  ///< Share of the walls that could stay closed which get a doorway as well, 0 to 1.
    std::uint64_t seed = 1;     ///< Same options, same scene.
};

/// A maze of rooms, the kind of scene on which importance pays: little of it is seen from anywhere, and light comes
/// round corners. Rooms of 5 to 7 m stand on a nearly square grid about the origin, z up, 2.8 m high; doorways join
/// them all, and each has one luminaire, about 8,000 lm, that shines downwards, and colours of its own.
///
/// All faces are one-sided: floors, walls, ceilings and the insides of doorways are together one closed surface that is
/// lit from inside; furniture is made of closed convex solids that keep 4 mm distance from each other and from it. A
/// room has about 50 patches, with furniture about 2,590, so that nine rooms are the size of the scene in Prikryl et
/// al. 2000 (23,182 patches). Objects are named "room-0.shell", "room-0.bookcase-1". The first 64 rooms have a view
/// each, "room-0" and so on, from a corner at eye height; the view "overview" looks in from above, through the
/// ceilings' backs.
///
/// Time and memory are linear in the rooms. @throws InputError where an option is out of its range.
Scene make_maze(const MazeOptions& options);

/// How many rooms a maze needs to have about `patches` patches, the other options as given; at least 1.
/// @throws InputError where that is more than most_rooms.
std::uint32_t maze_rooms_for(std::uint64_t patches, const MazeOptions& options);

}  // namespace interflect::inline detail
