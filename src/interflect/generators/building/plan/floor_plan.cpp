#include "interflect/generators/building/plan/floor_plan.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "interflect/generators/building/plan/random_sequence.h"

namespace interflect::detail::building {

namespace {

constexpr float wall_thickness = 0.2f;  // [m]
constexpr float door_width = 0.9f;      // [m]
constexpr float min_pier = 0.5f;        // between a doorway and a corner [m]

struct SharedWall {
    std::array<std::uint32_t, 2> rooms;
    Side side;  // of the first room
};

/// Sets of connected rooms.
class Connected {
  public:
    explicit Connected(std::size_t rooms) : parent_(rooms) { std::iota(parent_.begin(), parent_.end(), 0u); }

    /// Connects two rooms. Returns false if they were connected before.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[a] = b;
        return a != b;
    }

  private:
    std::uint32_t find(std::uint32_t room) {
        while (parent_[room] != room) room = parent_[room] = parent_[parent_[room]];
        return room;
    }
    std::vector<std::uint32_t> parent_;
};

/// Returns intervals that are separated by walls and centred at 0.
std::vector<Interval> draw_intervals(std::uint32_t count, const Interval& length, RandomSequence& random) {
    std::vector<Interval> intervals;
    float end = -wall_thickness;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float begin = end + wall_thickness;
        end = begin + random.between(length.low, length.high);
        intervals.push_back({begin, end});
    }
    const float middle = end / 2;
    for (Interval& interval : intervals) interval = {interval.low - middle, interval.high - middle};
    return intervals;
}

std::vector<SharedWall> shared_walls(std::uint32_t rooms, std::uint32_t columns) {
    std::vector<SharedWall> walls;
    for (std::uint32_t room = 0; room < rooms; ++room) {
        if ((room + 1) % columns != 0 && room + 1 < rooms) walls.push_back({{room, room + 1}, east});
        if (room + columns < rooms) walls.push_back({{room, room + columns}, north});
    }
    return walls;
}

/// Chooses walls for doorways: a random spanning tree by Kruskal's algorithm, and extra doors.
std::vector<bool> choose_walls(const std::vector<SharedWall>& walls, const PlanOptions& options,
                               RandomSequence& random) {
    std::vector<std::uint32_t> order(walls.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::uint32_t i = static_cast<std::uint32_t>(order.size()); i > 1; --i)
        std::swap(order[i - 1], order[random.below(i)]);
    Connected connected(options.rooms);
    std::vector<bool> chosen(walls.size());
    for (const std::uint32_t wall : order)
        chosen[wall] = connected.join(walls[wall].rooms[0], walls[wall].rooms[1]) || random.chance(options.extra_doors);
    return chosen;
}

/// Evenly spaced places align opposite doorways or keep them apart.
Interval draw_opening(const Interval& wall, RandomSequence& random) {
    const float places = std::floor((wall.length() - 2 * min_pier) / door_width);
    const float first = wall.middle() - places * door_width / 2;
    const auto place = static_cast<float>(random.below(static_cast<std::uint32_t>(places)));
    return {first + place * door_width, first + (place + 1) * door_width};
}

}  // namespace

FloorPlan make_floor_plan(const PlanOptions& options) {
    RandomSequence random(mix(options.seed, 0));
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(options.rooms))));
    const std::uint32_t rows = (options.rooms + columns - 1) / columns;
    const std::vector<Interval> x = draw_intervals(columns, options.width, random);
    const std::vector<Interval> y = draw_intervals(rows, options.depth, random);

    FloorPlan plan;
    for (std::uint32_t i = 0; i < options.rooms; ++i) plan.rooms.push_back({x[i % columns], y[i / columns]});
    const std::vector<SharedWall> walls = shared_walls(options.rooms, columns);
    const std::vector<bool> chosen = choose_walls(walls, options, random);
    for (std::size_t i = 0; i < walls.size(); ++i) {
        if (!chosen[i]) continue;
        const auto& [rooms, side] = walls[i];
        plan.rooms[rooms[0]].doorway[side] = static_cast<std::uint32_t>(plan.doorways.size());
        plan.rooms[rooms[1]].doorway[opposite(side)] = static_cast<std::uint32_t>(plan.doorways.size());
        plan.doorways.push_back({rooms, side, draw_opening(plan.rooms[rooms[0]].along(side), random)});
    }
    return plan;
}

}  // namespace interflect::detail::building
