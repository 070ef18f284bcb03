#include "interflect/generators/building/walls/shell.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace interflect::detail::building {

namespace {

/// Vertices around a doorway: low and high end at the floor, then high and low end at the top.
using DoorFrame = std::array<std::uint32_t, 4>;

std::vector<float> dividing_lines(const FloorPlan& plan, const Room& room, Side side) {
    const Interval& extent = room.along(side);
    std::vector<float> lines{extent.low, extent.high};
    for (const Side wall : {side, opposite(side)})
        if (const std::uint32_t doorway = room.doorway[wall]; doorway != none) {
            const Interval& opening = plan.doorways[doorway].opening;
            lines.insert(lines.end(), {opening.low, opening.high});
        }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
}

/// Box with opposite faces divided alike, to avoid T-vertices.
class RoomShell {
  public:
    RoomShell(Scene& scene, const FloorPlan& plan, const Room& room, const Finish& finish, std::uint32_t object)
        : scene_(scene),
          plan_(plan),
          room_(room),
          finish_(finish),
          object_(object),
          lines_{dividing_lines(plan, room, south),
                 dividing_lines(plan, room, west),
                 {0, plan.door_height, plan.room_height}},
          vertices_(lines_[0].size() * lines_[1].size() * lines_[2].size(), none) {}

    void add_faces() {
        for (int axis = 0; axis < 3; ++axis)
            for (const bool high : {false, true}) add_face(axis, high);
    }

    /// Valid after add_faces().
    const std::array<DoorFrame, side_count>& frames() const { return frames_; }

  private:
    using GridPoint = std::array<std::size_t, 3>;

    void add_face(int axis, bool high) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        GridPoint cell;
        cell[axis] = high ? lines_[axis].size() - 1 : 0;
        for (cell[v] = 0; cell[v] + 1 < lines_[v].size(); ++cell[v])
            for (cell[u] = 0; cell[u] + 1 < lines_[u].size(); ++cell[u]) add_cell(cell, axis, high, u, v);
    }

    void add_cell(const GridPoint& cell, int axis, bool high, int u, int v) {
        const auto corner = [&](std::size_t du, std::size_t dv) {
            GridPoint point = cell;
            point[u] += du;
            point[v] += dv;
            return vertex(point);
        };
        // Counter-clockwise about +axis.
        std::array<std::uint32_t, 4> corners{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        const auto side = static_cast<Side>(axis + (high ? 2 : 0));
        if (axis < 2 && is_opening(side, cell)) {
            frames_[side] = along_x(side) ? DoorFrame{corners[0], corners[3], corners[2], corners[1]} : corners;
            return;
        }
        if (high) std::reverse(corners.begin(), corners.end());
        const std::uint32_t material = axis < 2 ? finish_.wall : high ? finish_.ceiling : finish_.floor;
        scene_.patches.push_back({.vertices = corners, .material = material, .object = object_});
    }

    bool is_opening(Side side, const GridPoint& cell) const {
        const int along = along_x(side) ? 0 : 1;
        return room_.doorway[side] != none && cell[2] == 0 &&
               lines_[along][cell[along]] == plan_.doorways[room_.doorway[side]].opening.low;
    }

    std::uint32_t vertex(const GridPoint& point) {
        std::uint32_t& index = vertices_[(point[2] * lines_[1].size() + point[1]) * lines_[0].size() + point[0]];
        if (index == none) {
            index = static_cast<std::uint32_t>(scene_.vertices.size());
            scene_.vertices.emplace_back(lines_[0][point[0]], lines_[1][point[1]], lines_[2][point[2]]);
        }
        return index;
    }

    Scene& scene_;
    const FloorPlan& plan_;
    const Room& room_;
    const Finish& finish_;
    std::uint32_t object_;
    std::array<std::vector<float>, 3> lines_;  // along x, y and z
    std::vector<std::uint32_t> vertices_;
    std::array<DoorFrame, side_count> frames_{};
};

void add_passage(Scene& scene, const Doorway& doorway, const std::array<DoorFrame, 2>& frames, const Finish& finish,
                 std::uint32_t object) {
    const auto& [near, far] = frames;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        std::array<std::uint32_t, 4> corners{near[k], far[k], far[next], near[next]};
        if (along_x(doorway.side)) std::reverse(corners.begin(), corners.end());
        scene.patches.push_back(
            {.vertices = corners, .material = k == 0 ? finish.floor : finish.wall, .object = object});
    }
}

}  // namespace

void add_shell(Scene& scene, const FloorPlan& plan, std::span<const Finish> finishes) {
    std::vector<std::array<DoorFrame, 2>> frames(plan.doorways.size());
    const auto first_object = static_cast<std::uint32_t>(scene.objects.size());
    for (std::uint32_t i = 0; i < plan.rooms.size(); ++i) {
        scene.objects.push_back(fmt::format("room-{}.shell", i));
        const Room& room = plan.rooms[i];
        RoomShell shell(scene, plan, room, finishes[i], first_object + i);
        shell.add_faces();
        for (const Side side : {west, south, east, north})
            if (const std::uint32_t doorway = room.doorway[side]; doorway != none)
                frames[doorway][plan.doorways[doorway].rooms[0] == i ? 0 : 1] = shell.frames()[side];
    }
    for (std::size_t i = 0; i < plan.doorways.size(); ++i) {
        const std::uint32_t owner = plan.doorways[i].rooms[0];
        add_passage(scene, plan.doorways[i], frames[i], finishes[owner], first_object + owner);
    }
}

}  // namespace interflect::detail::building
