#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

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

/// Returns the number for about `patches` patches; ignores options.rooms. @throws InputError above max_rooms.
std::uint32_t maze_rooms_for(std::uint64_t patches, const MazeOptions& options);

}  // namespace interflect::detail
