// The view of scenes without views. Expected are the shares of its rays that meet fronts (view_coverage()) and of its
// pixels that show reflected light (path tracing); neither shares code with the choice of the view.
#include <ImathBox.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstddef>

#include "interflect/prepare.h"
#include "interflect/render.h"
#include "tests/checks/rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr float outer_x = 8, outer_y = 6, thickness = 0.4f, clear_height = 2.7f;  // of a building [m]

struct BuildingShape {
    bool two_sided = false;
    bool has_window = false;
    bool has_pane = false;
    int storeys = 1;
    float ground = 0;  // side of a square ground [m]
};

/// A building of slabs and walls that are closed solids, with a room on each storey and floors at multiples of 3.1 m.
/// The window of a room is 2 m x 1.3 m, 3% of its surfaces.
Scene building(const BuildingShape& shape) {
    Scene scene;
    scene.name = "building";
    add_material(scene, Rgb(0.7f), Rgb(0));
    const auto add_solid = [&](V3f low, V3f high) {
        shape.two_sided ? add_two_sided_box(scene, low, high) : add_box(scene, low, high, 0);
    };
    constexpr float left = outer_x / 2 - 1, right = outer_x / 2 + 1, sill = 0.9f, lintel = 2.2f;  // of the window
    for (int storey = 0; storey <= shape.storeys; ++storey) {
        const float z = static_cast<float>(storey) * (clear_height + thickness), top = z + clear_height;
        add_solid({0, 0, z - thickness}, {outer_x, outer_y, z});
        if (storey == shape.storeys) break;
        add_solid({0, 0, z}, {thickness, outer_y, top});
        add_solid({outer_x - thickness, 0, z}, {outer_x, outer_y, top});
        add_solid({thickness, outer_y - thickness, z}, {outer_x - thickness, outer_y, top});
        if (!shape.has_window) {
            add_solid({thickness, 0, z}, {outer_x - thickness, thickness, top});
            continue;
        }
        add_solid({thickness, 0, z}, {left, thickness, top});
        add_solid({right, 0, z}, {outer_x - thickness, thickness, top});
        add_solid({left, 0, z}, {right, thickness, z + sill});
        add_solid({left, 0, z + lintel}, {right, thickness, top});
        if (!shape.has_pane) continue;
        const std::uint32_t glass = add_material(scene, Rgb(0), Rgb(0));
        scene.materials[glass].transmittance = Rgb(0.8f);
        add_rectangle(scene, {left, thickness / 2, z + sill}, {right - left, 0, 0}, {0, 0, lintel - sill}, glass, 1, 1,
                      true);
    }
    if (shape.ground > 0) {
        const V3f corner((outer_x - shape.ground) / 2, (outer_y - shape.ground) / 2, -thickness - 0.01f);
        add_rectangle(scene, corner, {shape.ground, 0, 0}, {0, shape.ground, 0}, 0);
    }
    return scene;
}

Imath::Box3f room_of_storey(int storey) {
    const float z = static_cast<float>(storey) * (clear_height + thickness);
    return {{thickness, thickness, z}, {outer_x - thickness, outer_y - thickness, z + clear_height}};
}

void add_lamp(Scene& scene, V3f position) { scene.luminaires.push_back({"lamp", 0, PointLight{position, Rgb(100)}}); }
void add_sky_above(Scene& scene) { scene.luminaires.push_back({"sky", 0, UniformSky{Rgb(1000)}}); }
void add_sun(Scene& scene) {
    scene.luminaires.push_back({"sun", 0, DirectionalLight{{-0.3f, 0.7f, -0.5f}, Rgb(50'000)}});
}

/// Minimum shares of a view that may include the window, which fills a quarter of the picture from 2 m.
constexpr double through_window = 0.6;

/// Light in a picture of a view.
struct Seen {
    double fronts = 0;  // share of rays
    double lit = 0;     // share of pixels that show reflected light
};

Seen seen_from(const View& view, const Scene& scene, const RayCaster& ray_caster) {
    const ViewCoverage coverage = view_coverage(scene, ray_caster, view, 16.0f / 9);
    const Rendering picture =
        render(scene, ray_caster, view, {.width = 32, .height = 18, .shading = Shading::path, .samples = 64});
    const SampledLight& light = picture.layers.reflected;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < light.direct.pixels.size(); ++i)
        lit += largest_channel(light.direct.pixels[i] + light.indirect.pixels[i]) > 0;
    return {1 - coverage.nothing - coverage.backs,
            static_cast<double>(lit) / static_cast<double>(light.direct.pixels.size())};
}

/// Expects an overview from within a room. @param least  Minimum share of rays that meet fronts, and of lit pixels.
void expect_view_of_room(const Scene& scene, const Imath::Box3f& room, double least = 0.9) {
    const RayCaster ray_caster(scene);
    const View view = overview(scene, ray_caster);
    EXPECT_EQ(view.name, "overview");
    EXPECT_TRUE(room.intersects(V3f(view.eye - scene.origin))) << view.eye;
    const Seen seen = seen_from(view, scene, ray_caster);
    EXPECT_GT(seen.fronts, least);
    EXPECT_GT(seen.lit, least);
}

void expect_view_from_corner(const Scene& scene) {
    const View view = overview(scene, RayCaster(scene)), from_corner = overview(scene);
    EXPECT_EQ(view.eye, from_corner.eye);
    EXPECT_EQ(view.look_at, from_corner.look_at);
    EXPECT_EQ(view.fov, from_corner.fov);
}

TEST(LitOverview, IsInTheRoomOfALamp) {
    for (const bool two_sided : {false, true})
        for (const float ground : {0.0f, 12.0f, 100.0f}) {
            SCOPED_TRACE(testing::Message() << two_sided << ' ' << ground);
            Scene scene = building({.two_sided = two_sided, .ground = ground});
            add_lamp(scene, {4, 3, 2.5f});
            expect_view_of_room(scene, room_of_storey(0));
            if (!two_sided && ground == 0) continue;  // the corner is in a solid, whose backs rays pass
            EXPECT_LT(seen_from(overview(scene), scene, RayCaster(scene)).lit, 0.1) << "from the corner";
        }
}

TEST(LitOverview, IsInTheRoomOfALampUnderTheSky) {
    Scene scene = building({.ground = 100});
    add_lamp(scene, {4, 3, 2.5f});
    add_sky_above(scene);
    expect_view_of_room(scene, room_of_storey(0));
}

TEST(LitOverview, IsInTheRoomOfEmittingFaces) {
    Scene scene = building({.two_sided = true});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(1000));
    add_box(scene, {3, 2, 2.4f}, {5, 4, 2.6f}, lamp);  // black, so its pixels reflect no light
    expect_view_of_room(scene, room_of_storey(0), 0.7);
}

/// glTF files have y up. Lamps that shine down and the low building show it.
TEST(LitOverview, IsUprightInABuildingWithAnotherUpAxis) {
    Scene scene = building({.two_sided = true});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(1000));
    add_rectangle(scene, {3, 2, 2.6f}, {0, 2, 0}, {2, 0, 0}, lamp);
    expect_view_of_room(scene, room_of_storey(0), 0.7);
    for (V3f& x : scene.vertices) x = {x.x, x.z, -x.y};
    const Imath::Box3f room = room_of_storey(0);
    expect_view_of_room(scene, {{room.min.x, room.min.z, -room.max.y}, {room.max.x, room.max.z, -room.min.y}}, 0.7);
    EXPECT_EQ(overview(scene, RayCaster(scene)).up, V3f(0, 1, 0));
}

TEST(LitOverview, IsOnTheStoreyWithALamp) {
    for (const int storey : {0, 1, 2}) {
        Scene scene = building({.has_window = true, .storeys = 3, .ground = 60});
        add_lamp(scene, {4, 3, room_of_storey(storey).max.z - 0.2f});
        expect_view_of_room(scene, room_of_storey(storey), through_window);
    }
}

TEST(LitOverview, IsInARoomLitThroughAWindow) {
    for (const bool has_pane : {false, true})
        for (const bool two_sided : {false, true}) {
            SCOPED_TRACE(testing::Message() << has_pane << ' ' << two_sided);
            const Scene scene =
                building({.two_sided = two_sided, .has_window = true, .has_pane = has_pane, .ground = 30});
            Scene with_sky = scene, with_sun = scene, with_both = scene;
            add_sky_above(with_sky);
            add_sun(with_sun);
            add_sky_above(with_both);
            add_sun(with_both);
            for (const Scene& lit : {with_sky, with_sun, with_both})
                expect_view_of_room(lit, room_of_storey(0), through_window);
        }
}

TEST(LitOverview, IsInTheLitOneOfManyRooms) {
    // 3 x 3 rooms of 3.8 m between walls of 0.2 m
    Scene scene;
    add_material(scene, Rgb(0.7f), Rgb(0));
    add_box(scene, {0, 0, -0.3f}, {12.2f, 12.2f, 0}, 0);
    add_box(scene, {0, 0, 2.5f}, {12.2f, 12.2f, 2.8f}, 0);
    for (int i = 0; i <= 3; ++i) {
        const float x = 4 * static_cast<float>(i);
        add_box(scene, {x, 0, 0}, {x + 0.2f, 12.2f, 2.5f}, 0);
        for (int j = 0; j < 3; ++j) {
            const float y = 4 * static_cast<float>(j);
            add_box(scene, {y + 0.2f, x, 0}, {y + 4, x + 0.2f, 2.5f}, 0);
        }
    }
    add_lamp(scene, {6, 6, 2.4f});
    expect_view_of_room(scene, {{4.2f, 4.2f, 0}, {8, 8, 2.5f}});
}

TEST(LitOverview, KeepsTheCornerOfALitRoom) {
    Scene scene = closed_box({4, 6, 3}, 1, {{"wall", Rgb(0.5f), Rgb(0)}});
    add_lamp(scene, {2, 3, 2.9f});
    expect_view_from_corner(scene);
    // Without a ceiling, below the sky
    Scene open = two_sided_room({4, 6, 3});
    open_ceiling(open, {0, 0}, {4, 6});
    add_sky_above(open);
    expect_view_from_corner(open);
}

TEST(LitOverview, KeepsTheCornerOfABoxWithAnOpenFront) {
    Scene scene;
    const std::uint32_t wall = add_material(scene, Rgb(0.7f), Rgb(0)), lamp = add_material(scene, Rgb(0), Rgb(10));
    const V3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0, 0, 0);
    add_rectangle(scene, o, x, y, wall);
    add_rectangle(scene, z, y, x, wall);
    add_rectangle(scene, o, y, z, wall);
    add_rectangle(scene, x, z, y, wall);
    add_rectangle(scene, y, x, z, wall);  // the front, y = 0, is open
    add_rectangle(scene, {0.35f, 0.35f, 0.999f}, {0, 0.3f, 0}, {0.3f, 0, 0}, lamp);
    expect_view_from_corner(scene);
}

TEST(LitOverview, KeepsTheCornerOfOpenScenes) {
    Scene ground;
    add_material(ground, Rgb(0.5f), Rgb(0));
    add_rectangle(ground, {-40, -40, 0}, {80, 0, 0}, {0, 80, 0}, 0);
    add_sky_above(ground);
    // A block, a table, a city of blocks with streets of 4 m
    Scene block = ground;
    add_box(block, {-1, -1, 0.001f}, {1, 1, 2}, 0);
    expect_view_from_corner(block);
    Scene table = ground;
    add_box(table, {-0.8f, -0.4f, 0.7f}, {0.8f, 0.4f, 0.75f}, 0);
    for (const float leg_x : {-0.8f, 0.75f})
        for (const float leg_y : {-0.4f, 0.35f})
            add_box(table, {leg_x, leg_y, 0.001f}, {leg_x + 0.05f, leg_y + 0.05f, 0.7f}, 0);
    expect_view_from_corner(table);
    Scene city = ground;
    for (int i = -3; i < 3; ++i)
        for (int j = -3; j < 3; ++j) {
            const V3f low(static_cast<float>(12 * i + 1), static_cast<float>(12 * j + 1), 0.001f);
            add_box(city, low, low + V3f(8, 8, static_cast<float>(6 + 4 * ((7 * i + 3 * j + 30) % 5))), 0);
        }
    expect_view_from_corner(city);
}

TEST(LitOverview, KeepsTheCornerOfASingleObject) {
    Scene solid;
    add_material(solid, Rgb(0.5f), Rgb(0));
    add_box(solid, {-1, -1, 0}, {1, 1, 2}, 0);
    add_sky_above(solid);
    expect_view_from_corner(solid);
    // The inside of a lamp is lit, but no room
    Scene lamp;
    add_material(lamp, Rgb(0.5f), Rgb(0));
    add_rectangle(lamp, {-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 0);
    add_two_sided_box(lamp, {-0.3f, -0.3f, 0.1f}, {0.3f, 0.3f, 0.5f});
    add_lamp(lamp, {0, 0, 0.3f});
    add_lamp(lamp, {2, 2, 3});
    expect_view_from_corner(lamp);
}

TEST(LitOverview, KeepsTheCornerWhereNoRoomIsLit) {
    expect_view_from_corner(building({.has_window = true, .ground = 30}));
    expect_view_from_corner(building({.two_sided = true}));
    Scene closed = building({.ground = 30});
    add_sky_above(closed);
    add_sun(closed);
    expect_view_from_corner(closed);
    EXPECT_NO_THROW(overview(Scene{}, RayCaster(Scene{})));
}

TEST(LitOverview, ReplacesADarkViewOfAnOpenScene) {
    // The corner is in a wall, below a roof on columns
    Scene scene;
    add_material(scene, Rgb(0.5f), Rgb(0));
    add_two_sided_box(scene, {0, 0, -0.4f}, {8, 6, 0});
    add_two_sided_box(scene, {0, 0, 0.001f}, {1, 1, 2.499f});
    add_two_sided_box(scene, {7, 5, 0.001f}, {8, 6, 2.499f});
    add_two_sided_box(scene, {0, 0, 2.5f}, {8, 6, 2.8f});
    add_sky_above(scene);
    const RayCaster ray_caster(scene);
    EXPECT_EQ(seen_from(overview(scene), scene, ray_caster).lit, 0);
    EXPECT_GT(seen_from(overview(scene, ray_caster), scene, ray_caster).lit, 0.3);
}

TEST(LitOverview, MovesWithTheOriginAndIsTheSameForAnyNumberOfThreads) {
    Scene scene = building({.has_window = true, .ground = 30});
    add_sky_above(scene);
    const View view = overview(scene, RayCaster(scene));
    scene.origin = {1e6, -2e6, 300};
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const View moved = overview(scene, RayCaster(scene));
    EXPECT_LT((moved.eye - view.eye - scene.origin).length(), 1e-8);
    EXPECT_LT((moved.look_at - view.look_at - scene.origin).length(), 1e-8);
}

TEST(LitOverview, RefusesTheRayCasterOfAnotherScene) {
    EXPECT_THROW(overview(building({}), RayCaster(building({.storeys = 2}))), InputError);
}

}  // namespace
}  // namespace interflect
