// Properties of mazes: size, connections between rooms, and visibility.
#include "interflect/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/generators/building/plan/floor_plan.h"
#include "interflect/generators/building/walls/solids.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/camera.h"
#include "interflect/scene.h"

namespace interflect {

using namespace detail;
namespace {

constexpr std::uint64_t seeds = 20;

TEST(Maze, NineFurnishedRoomsAreTheSizeOfThePapersScene) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const std::size_t patches = make_maze({.rooms = 9, .furniture = true, .seed = seed}).patches.size();
        EXPECT_TRUE(patches >= 22'000 && patches <= 24'500) << patches << ", seed " << seed;
    }
}

TEST(Maze, EmptyRoomsHaveFewPatches) {
    for (const std::uint32_t rooms : {1u, 4u, 64u, 400u})
        EXPECT_LT(make_maze({.rooms = rooms}).patches.size(), 60 * rooms) << rooms;
}

TEST(Maze, RoomsForPatches) {
    for (const bool furniture : {false, true}) {
        MazeOptions maze{.furniture = furniture};
        maze.rooms = maze_rooms_for(200'000, maze);
        EXPECT_NEAR(static_cast<double>(make_maze(maze).patches.size()), 200'000, 0.05 * 200'000);
    }
    EXPECT_EQ(maze_rooms_for(1, {}), 1u);
    EXPECT_THROW(maze_rooms_for(100'000'000, {.furniture = true}), InputError);
}

TEST(Maze, RefusesOptionsOutOfRange) {
    EXPECT_THROW(make_maze({.rooms = 0}), InputError);
    EXPECT_THROW(make_maze({.rooms = MazeOptions::max_rooms + 1}), InputError);
    EXPECT_THROW(make_maze({.extra_doors = -0.1f}), InputError);
    EXPECT_THROW(make_maze({.extra_doors = 1.1f}), InputError);
    EXPECT_THROW(make_maze({.extra_doors = NAN}), InputError);
}

TEST(Maze, ThingsAreFartherApartThanRaysAreLifted) {
    // Otherwise a ray from the underside of an object would start below its support.
    const Scene scene = make_maze({.rooms = MazeOptions::max_rooms});
    const RayCaster ray_caster(scene);
    for (PatchIndex i{0}; i < scene.patches.size(); i += 101) EXPECT_LT(ray_caster.ray_offset(i), building::gap);
}

TEST(Maze, FirstRoomsHaveViews) {
    const Scene small = make_maze({.rooms = 5}), large = make_maze({.rooms = 100});
    EXPECT_EQ(small.views.size(), 6u);
    EXPECT_EQ(large.views.size(), 65u);
    EXPECT_NO_THROW(find_view(large, "room-63"));
    EXPECT_NO_THROW(find_view(large, "overview"));
}

// ---- Doorways

/// Computes the Euler characteristic of the closed surface of an unfurnished maze: V - E + F = 2 (pieces - holes),
/// where holes are the independent loops through its rooms. It is 2 if exactly one path connects any two rooms.
std::int64_t euler_characteristic(const Scene& scene) {
    std::set<std::uint32_t> vertices;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::int64_t faces = 0;
    for (const Patch& patch : scene.patches) {
        if (!scene.objects[patch.object].ends_with(".shell")) continue;
        ++faces;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t a = patch.vertices[k], b = patch.vertices[(k + 1) % 4];
            vertices.insert(a);
            edges.insert(std::minmax(a, b));
        }
    }
    return std::ssize(vertices) - std::ssize(edges) + faces;
}

/// Rooms share vertices through doorways only.
std::int64_t pieces(const Scene& scene) {
    std::vector<std::uint32_t> parent(scene.vertices.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::set<std::uint32_t> roots, used;
    for (const Patch& patch : scene.patches)
        if (scene.objects[patch.object].ends_with(".shell"))
            for (const std::uint32_t v : patch.vertices) {
                parent[find(v)] = find(patch.vertices[0]);
                used.insert(v);
            }
    for (const std::uint32_t v : used) roots.insert(find(v));
    return std::ssize(roots);
}

/// Number of doorways, from their soffits: faces at a door's height that face down.
std::int64_t doorways(const Scene& scene) {
    return std::count_if(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
        return scene.objects[patch.object].ends_with(".shell") && scene.vertices[patch.vertices[0]].z < 2.5f &&
               PatchGeometry(scene, patch).normal() == V3f(0, 0, -1);
    });
}

TEST(Maze, DoorwaysJoinAllRooms) {
    for (const std::uint32_t rooms : {1u, 2u, 3u, 7u, 9u, 64u, 150u})
        for (std::uint64_t seed = 1; seed <= seeds; ++seed)
            EXPECT_EQ(pieces(make_maze({.rooms = rooms, .seed = seed})), 1) << rooms << " rooms, seed " << seed;
}

TEST(Maze, WithoutExtraDoorsThereIsOneWayOnly) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const Scene scene = make_maze({.rooms = 50, .extra_doors = 0, .seed = seed});
        EXPECT_EQ(doorways(scene), 49);
        EXPECT_EQ(euler_characteristic(scene), 2);
    }
}

TEST(Maze, ExtraDoorsMakeMoreWays) {
    // 7 x 7 rooms have 84 walls between them; a tree needs 48.
    const Scene some = make_maze({.rooms = 49, .extra_doors = 0.25f}), all = make_maze({.rooms = 49, .extra_doors = 1});
    EXPECT_NEAR(static_cast<double>(doorways(some)), 48 + 9, 7);
    EXPECT_EQ(doorways(all), 84);
    EXPECT_EQ(euler_characteristic(some), 2 - 2 * (doorways(some) - 48)) << "each further doorway is a hole";
    EXPECT_EQ(euler_characteristic(all), 2 - 2 * 36);
}

TEST(FloorPlan, DoorwaysAcrossARoomAreAbreastOrApart) {
    const building::FloorPlan plan = building::make_floor_plan({.rooms = 400, .extra_doors = 1});
    int abreast = 0, apart = 0;
    for (const building::Room& room : plan.rooms)
        for (const building::Side side : {building::west, building::south}) {
            const std::uint32_t a = room.doorway[side], b = room.doorway[opposite(side)];
            if (a == none || b == none) continue;
            const building::Interval &p = plan.doorways[a].opening, &q = plan.doorways[b].opening;
            EXPECT_TRUE(p == q || p.high <= q.low || q.high <= p.low);
            ++(p == q ? abreast : apart);
        }
    EXPECT_GT(abreast, 50);
    EXPECT_GT(apart, 50);
}

/// Returns whether rays from `start` along the middle line of a doorway, at several heights, are free for `length`.
bool is_free(const RayCaster& ray_caster, const V3f& start, const V3f& direction, float length) {
    std::vector<Ray> rays;
    for (const float z : {0.1f, 0.5f, 1.0f, 1.5f, 2.0f}) rays.push_back({{start.x, start.y, z}, direction});
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
    return std::all_of(hits.begin(), hits.end(), [&](const Hit& hit) { return hit.distance > length; });
}

TEST(Maze, DoorwaysAreKeptFree) {
    constexpr float before = 0.9f, wall = 0.2f;  // [m]
    const MazeOptions options{.rooms = 49, .furniture = true};
    const RayCaster ray_caster(make_maze(options));
    const building::FloorPlan plan =
        building::make_floor_plan({.rooms = options.rooms, .extra_doors = options.extra_doors, .seed = options.seed});
    for (const building::Doorway& doorway : plan.doorways) {
        const float face = plan.rooms[doorway.rooms[0]].wall(doorway.side);
        for (const float along :
             {doorway.opening.low + 0.01f, doorway.opening.middle(), doorway.opening.high - 0.01f}) {
            const bool north = along_x(doorway.side);
            const V3f start = north ? V3f(along, face - before, 0) : V3f(face - before, along, 0);
            EXPECT_TRUE(is_free(ray_caster, start, north ? V3f(0, 1, 0) : V3f(1, 0, 0), wall + 2 * before));
        }
    }
}

// ---- Views

/// Shares of a 16:9 picture that show the furniture of the camera's own room, and other rooms.
struct Seen {
    double furniture = 0, other_rooms = 0;
};

Seen seen_in(const Scene& scene, const RayCaster& ray_caster, const View& view) {
    constexpr int width = 160, height = 90;
    const Camera camera(view, width, height, scene.origin);
    std::vector<Ray> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rays.push_back(camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
    Seen seen;
    for (const Hit& hit : hits) {
        if (hit.patch == none) {
            ADD_FAILURE() << view.name << " looks out of the maze";
            break;
        }
        const std::string& object = scene.objects[scene.patches[hit.patch].object];
        const bool here = object.starts_with(view.name + '.');
        seen.other_rooms += !here / double{width * height};
        seen.furniture += (here && !object.ends_with(".shell")) / double{width * height};
    }
    return seen;
}

TEST(Maze, ViewsShowFurnitureAndADoorway) {
    for (const std::uint32_t rooms : {9u, 64u}) {
        const Scene scene = make_maze({.rooms = rooms, .furniture = true});
        const RayCaster ray_caster(scene);
        for (const View& view : scene.views) {
            if (view.name == "overview") continue;
            const Seen seen = seen_in(scene, ray_caster, view);
            EXPECT_GT(seen.furniture, 0.05) << view.name;
            EXPECT_GT(seen.other_rooms, 0.003) << view.name << " of " << rooms;
        }
    }
}

}  // namespace
}  // namespace interflect
