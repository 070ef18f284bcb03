#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

struct MazeOptions {
    static constexpr std::uint32_t most_rooms = 10'000;

    std::uint32_t rooms = 9;    ///< 1 to most_rooms.
    bool furniture = false;     ///< Adds bookcases, desks, chairs, tables and other furniture.
    float extra_doors = 0.15f;  ///< Fraction of the remaining walls that also get a doorway, 0 to 1.
    std::uint64_t seed = 1;     ///< Equal options give equal scenes.
};

/// Creates a maze of rooms, which suits view importance: each view sees little of it, and much light is indirect. Rooms
/// of 5 to 7 m, 2.8 m high, stand on a nearly square grid about the origin, z up, and are connected by doorways. Each
/// has its own colours and one luminaire of about 8,000 lm that shines downwards.
///
/// All faces are one-sided. Floors, walls, ceilings and the insides of doorways form one closed surface lit from
/// inside. Furniture consists of closed convex solids, 4 mm apart from each other and from that surface. A room has
/// about 50 patches, with furniture 2,590; nine such rooms match the scene in Prikryl et al. 2000 (23,182 patches).
/// Objects are named "room-0.shell", "room-0.bookcase-1". The first 64 rooms have a view "room-0" and so on from a
/// corner at eye height; "overview" shows the maze from above, through the backs of the ceilings.
///
/// Time and memory are linear in the rooms. @throws InputError if an option is out of its range.
Scene make_maze(const MazeOptions& options);

/// Number of rooms, at least 1, with which a maze of these options has about `patches` patches.
/// @throws InputError if that exceeds most_rooms.
std::uint32_t maze_rooms_for(std::uint64_t patches, const MazeOptions& options);

}  // namespace interflect::detail
