#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::inline detail::building {

struct Interval {
    float low = 0, high = 0;  ///< [m]
    float length() const { return high - low; }
    float middle() const { return (low + high) / 2; }
    bool operator==(const Interval&) const = default;
};

/// The walls of a room, by where they are.
enum Side : std::uint8_t { west, south, east, north };
inline constexpr int side_count = 4;
constexpr Side opposite(Side side) { return static_cast<Side>((side + 2) % side_count); }
/// Whether a wall runs along x (south and north do); else along y.
constexpr bool along_x(Side side) { return side % 2 == 1; }

/// A rectangular room; its extent is that of the floor, between the faces of the walls.
struct Room {
    Interval x, y;
    std::array<std::uint32_t, side_count> doorway{none, none, none, none};  ///< Index of the one in each wall.

    /// The extent along a wall.
    const Interval& along(Side side) const { return along_x(side) ? x : y; }
    /// Where the face of a wall is, across it.
    float wall(Side side) const {
        const Interval& across = along_x(side) ? y : x;
        return side == west || side == south ? across.low : across.high;
    }
};

/// An opening from the floor up, through the wall that two rooms share.
struct Doorway {
    std::array<std::uint32_t, 2> rooms{none, none};  ///< The western or southern one first.
    Side side = east;                                ///< Of the first room: east or north.
    Interval opening;                                ///< Along the wall.
};

/// Rooms on a grid, joined by doorways, about the origin; floors at z = 0.
struct FloorPlan {
    float room_height = 2.8f, door_height = 2.1f;  ///< [m]
    std::vector<Room> rooms;                       ///< By rows from south to north, each from west to east.
    std::vector<Doorway> doorways;
};

struct PlanOptions {
    std::uint32_t rooms = 1;
    Interval width{5.2f, 6.8f}, depth{5.2f, 6.8f};  ///< Of rooms along x and y, drawn for each column and row [m].
    float extra_doors = 0;  ///< Share of the walls between rooms without need of a doorway that get one, 0 to 1.
    std::uint64_t seed = 1;
};

/// A nearly square grid of rooms. Doorways make a random spanning tree of it, so that there is a way from every room to
/// every other, and some more. Doorways in opposite walls of a room are exactly abreast, or do not overlap: their
/// edges, carried through the room, never cut each other. Time and memory are linear in the rooms.
FloorPlan make_floor_plan(const PlanOptions& options);

}  // namespace interflect::inline detail::building
