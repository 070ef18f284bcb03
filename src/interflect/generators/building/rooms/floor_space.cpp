#include "interflect/generators/building/rooms/floor_space.h"

#include <algorithm>

namespace interflect::detail::building {

namespace {

using Imath::Box2f;
using Imath::V2f;

constexpr float way_length = 1.0f;   // free floor before a doorway [m]
constexpr float way_margin = 0.05f;  // on both sides of a way [m]
constexpr float aisle = 0.35f;       // from free-standing furniture to walls [m]
constexpr int random_tries = 40;
constexpr int tried_places = 100;  // per wall, if random tries fail

int quarter_turns_from(Side wall) {
    switch (wall) {
        case south:
            return 0;
        case east:
            return 1;
        case north:
            return 2;
        default:
            return 3;
    }
}

/// Returns the floor along a wall, between two distances from it.
Box2f beside_wall(const Room& room, Side wall, const Interval& along, float from, float to) {
    const float inwards = wall == west || wall == south ? 1.f : -1.f;
    const float a = room.wall(wall) + inwards * from, b = room.wall(wall) + inwards * to;
    const auto [low, high] = std::minmax(a, b);
    return along_x(wall) ? Box2f(V2f(along.low, low), V2f(along.high, high))
                         : Box2f(V2f(low, along.low), V2f(high, along.high));
}

bool overlap(const Box2f& a, const Box2f& b) {
    return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

}  // namespace

FloorSpace::FloorSpace(const FloorPlan& plan, const Room& room) : room_(room) {
    for (const Side side : {west, south, east, north})
        if (const std::uint32_t doorway = room.doorway[side]; doorway != none) {
            const Interval& opening = plan.doorways[doorway].opening;
            reserve(beside_wall(room, side, {opening.low - way_margin, opening.high + way_margin}, 0, way_length));
        }
}

std::optional<Placement> FloorSpace::reserve_if_free(const Furniture& piece, Side back, const V2f& origin) {
    const Interval width = along_x(back) ? Interval{origin.x - piece.width / 2, origin.x + piece.width / 2}
                                         : Interval{origin.y - piece.width / 2, origin.y + piece.width / 2};
    const float distance = std::abs((along_x(back) ? origin.y : origin.x) - room_.wall(back));
    const float depth = piece.depth + piece.clearance;
    const Box2f part = beside_wall(room_, back, width, distance, distance + depth);
    if (std::any_of(taken_.begin(), taken_.end(), [&](const Box2f& other) { return overlap(part, other); }))
        return std::nullopt;
    taken_.push_back(part);
    return Placement::quarter_turned({origin.x, origin.y, 0}, quarter_turns_from(back));
}

std::optional<Placement> FloorSpace::against_wall(const Furniture& piece, RandomSequence& random) {
    const auto try_at = [&](Side wall, float share) {
        const Interval& extent = room_.along(wall);
        const float along = extent.low + piece.width / 2 + (extent.length() - piece.width) * share;
        return reserve_if_free(piece, wall,
                               along_x(wall) ? V2f(along, room_.wall(wall)) : V2f(room_.wall(wall), along));
    };
    for (int i = 0; i < random_tries; ++i) {
        const auto wall = static_cast<Side>(random.below(side_count));
        if (auto place = try_at(wall, random.uniform())) return place;
    }
    for (const Side wall : {west, south, east, north})
        for (int i = 0; i <= tried_places; ++i)
            if (auto place = try_at(wall, static_cast<float>(i) / tried_places)) return place;
    return std::nullopt;
}

std::optional<Placement> FloorSpace::in_the_open(const Furniture& piece, RandomSequence& random) {
    for (int i = 0; i < random_tries; ++i) {
        const auto back = random.chance(.5f) ? south : west;
        const float room_width = room_.along(back).length(), room_depth = (along_x(back) ? room_.y : room_.x).length();
        const float along =
            room_.along(back).low + random.between(aisle + piece.width / 2, room_width - aisle - piece.width / 2);
        const float across = room_.wall(back) + random.between(aisle, room_depth - aisle - piece.depth);
        if (auto place = reserve_if_free(piece, back, along_x(back) ? V2f(along, across) : V2f(across, along)))
            return place;
    }
    return std::nullopt;
}

}  // namespace interflect::detail::building
