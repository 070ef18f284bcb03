#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail::building {

struct Interval {
    float low = 0, high = 0;  ///< [m]
    float length() const { return high - low; }
    float middle() const { return (low + high) / 2; }
    bool operator==(const Interval&) const = default;
};

enum Side : std::uint8_t { west, south, east, north };
inline constexpr int side_count = 4;
constexpr Side opposite(Side side) { return static_cast<Side>((side + 2) % side_count); }
constexpr bool along_x(Side side) { return side % 2 == 1; }

struct Room {
    Interval x, y;
    std::array<std::uint32_t, side_count> doorway{none, none, none, none};  ///< Indices into FloorPlan::doorways.

    /// Returns the extent of a wall along its axis.
    const Interval& along(Side side) const { return along_x(side) ? x : y; }
    /// Returns the position of a wall on the other axis [m].
    float wall(Side side) const {
        const Interval& across = along_x(side) ? y : x;
        return side == west || side == south ? across.low : across.high;
    }
};

struct Doorway {
    std::array<std::uint32_t, 2> rooms{none, none};  ///< West or south room first.
    Side side = east;                                ///< In the first room: east or north.
    Interval opening;                                ///< Along the wall.
};

/// Rooms and doorways of one storey, centred at the origin, with floors at z = 0.
struct FloorPlan {
    float room_height = 2.8f, door_height = 2.1f;  ///< [m]
    std::vector<Room> rooms;                       ///< By rows from the south, each from the west.
    std::vector<Doorway> doorways;
};

struct PlanOptions {
    std::uint32_t rooms = 1;
    Interval width{5.2f, 6.8f}, depth{5.2f, 6.8f};  ///< Per column and row [m].
    float extra_doors = 0;                          ///< Fraction of walls outside the spanning tree, 0 to 1.
    std::uint64_t seed = 1;
};

/// Creates a nearly square grid of rooms, connected by a random spanning tree of doorways and `extra_doors`.
FloorPlan make_floor_plan(const PlanOptions& options);

}  // namespace interflect::detail::building
