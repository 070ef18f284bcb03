#include <ImathEuler.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/exports/gltf/lightmap_images.h"
#include "interflect/exports/lightmap/baked_light.h"
#include "interflect/generate.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/prepare.h"
#include "interflect/render/smooth/smooth_field.h"
#include "interflect/solve.h"
#include "tests/exports/lightmap/lightmaps.h"
#include "tests/support/parameter_names.h"
#include "tests/support/refusals.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::add_material;
using testing_support::add_rectangle;
using testing_support::closed_box;
using namespace lightmap_testing;

const Material grey{"grey", Rgb(0.5f), Rgb(0)};

/// A floor of 4 x 4 m, turned by 30 degrees, as triangles and quadrilaterals of one surface, with a hole.
Scene turned_floor() {
    Scene scene;
    const float c = std::cos(0.52f), s = std::sin(0.52f);
    add_rectangle(scene, V3f(1, 2, 0.5f), V3f(4 * c, 4 * s, 0), V3f(-4 * s, 4 * c, 0),
                  add_material(scene, Rgb(0.5f), Rgb(0)), 4, 4);
    scene.patches.erase(scene.patches.begin() + 5);
    Patch& quadrilateral = scene.patches[9];
    Patch half = quadrilateral;
    half.vertices = {quadrilateral.vertices[0], quadrilateral.vertices[2], quadrilateral.vertices[3], none};
    quadrilateral.vertices[3] = none;
    scene.patches.push_back(half);
    return scene;
}

TEST(Lightmap, FlatSurfaceIsOneChart) {
    const Scene scene = turned_floor();
    const auto charts = make_charts(scene, std::vector<bool>(scene.patches.size(), true), *at(10).lightmap);
    ASSERT_EQ(charts.size(), 1);
    EXPECT_NEAR(charts[0].size.x, 4, 1e-5);  // not the 5.5 m of a rectangle along the axes
    EXPECT_NEAR(charts[0].size.y, 4, 1e-5);
    EXPECT_EQ(charts[0].columns, 41);
}

TEST(Lightmap, ChartsWithTheirGuttersAreApart) {
    const Scene scene = closed_box(V3f(3, 4, 2.5f), 1, std::vector<Material>(6, grey));
    ExportOptions options = at(33);
    options.lightmap->max_size = 256;  // several images
    const Lightmap lightmap = make_lightmap(scene, uniform(scene, 1), options);
    EXPECT_GT(lightmap.images.size(), 1);
    const int gutter = options.lightmap->gutter;
    for (const LightmapChart& a : lightmap.charts) {
        const Image& image = lightmap.images[static_cast<std::size_t>(a.page)];
        EXPECT_TRUE(a.left >= gutter && a.left + a.columns + gutter <= image.width);
        EXPECT_TRUE(a.top >= gutter && a.top + a.rows + gutter <= image.height);
        EXPECT_TRUE(image.width % 4 == 0 && image.height % 4 == 0);
        for (const LightmapChart& b : lightmap.charts) {
            if (&a == &b || a.page != b.page) continue;
            EXPECT_TRUE(a.left + a.columns + 2 * gutter <= b.left || b.left + b.columns + 2 * gutter <= a.left ||
                        a.top + a.rows + 2 * gutter <= b.top || b.top + b.rows + 2 * gutter <= a.top);
        }
    }
}

class RoomLightmap : public testing::TestWithParam<V3f> {};  // size of the room [m]

TEST_P(RoomLightmap, UsesFourFifthsOfTheTexels) {
    const Scene scene = closed_box(GetParam(), 1, std::vector<Material>(6, grey));
    const Lightmap lightmap = make_lightmap(scene, uniform(scene, 1), at(20));
    EXPECT_GT(lightmap.covered, 0.8);
    EXPECT_GE(lightmap.used, lightmap.covered);
}

// Exact: borders that included texels beside the chart would be darker. Fails if gutters are not filled.
TEST_P(RoomLightmap, HasNoDarkOrBrightBorders) {
    const Scene scene = closed_box(GetParam(), 1, std::vector<Material>(6, grey));
    const Solution solution = uniform(scene, 3);
    const Lightmap lightmap = make_lightmap(scene, solution, at(20));
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        for (std::uint64_t i = 0; i < 1000; ++i) {
            const PatchGeometry& geometry = solution.forest->geometry(p);
            ASSERT_NEAR(sample(lightmap, p, random_place(geometry, i)).x, 3, 1e-5);
        }
}

// As seen from the lit side. Fails if charts that are turned in the atlas are mirrored.
TEST_P(RoomLightmap, IsNotMirrored) {
    const Scene scene = closed_box(GetParam(), 1, std::vector<Material>(6, grey));
    const Lightmap lightmap = make_lightmap(scene, uniform(scene, 1), at(20));
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const V2f origin = lightmap.coordinate(p, {0, 0});
        EXPECT_GT((lightmap.coordinate(p, {1, 0}) - origin).cross(lightmap.coordinate(p, {0, 1}) - origin), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RoomLightmap,
                         testing::Values(V3f(3, 4, 2.5f), V3f(6, 8, 2.7f), V3f(12, 5, 3), V3f(2, 2, 2)),
                         testing_support::printed_name);

// Packing the charts takes longer than a fast test may.
TEST(Lightmap, TooFineOnesAreRefusedBeforeTheyArePacked) {
    Scene scene;
    add_material(scene, Rgb(0.5f), Rgb(1));
    for (int i = 0; i < (is_sanitized ? 1000 : 10'000); ++i)
        add_rectangle(scene, V3f(0, 0, 0.01f * static_cast<float>(i)), V3f(1, 0, 0), V3f(0, 0.5f, 0), 0);
    const Solution solution = solve(scene, RayCaster(scene), {.limits = {.rays = 1000}});
    ExportOptions options = at(1e5f);
    options.lightmap->max_bytes = 1 << 30;
    EXPECT_EQ(testing_support::refused_setting([&] { make_lightmap(scene, solution, options); }), "texels_per_metre");
}

/// The fractions of used and covered texels were 0 / 0.
TEST(Lightmap, WithoutChartsUsesNoTexels) {
    const Scene scene = turned_floor();
    std::vector<LightmapChart> no_charts;
    const PackCharts no_images = [](std::vector<LightmapChart>&) { return std::vector<Imath::V2i>(); };
    const MoveTexels keep_places = [](std::size_t, std::span<TexelPlace>) {};
    const BakedImages baked = bake_charts(no_charts, no_images, keep_places, scene, uniform(scene, 1), at(10));
    EXPECT_TRUE(baked.images.empty());
    EXPECT_EQ(baked.used, 0);
    EXPECT_EQ(baked.covered, 0);
}

// A lightmap with texels smaller than the elements matches smooth shading, at borders too. The difference is the
// error of bilinear interpolation between texels: about a tenth of the change over an element. Fails with charts that
// are shifted by half a texel, mirrored or stretched.
TEST(Lightmap, IsWhatSmoothShadingHas) {
    const Scene scene = turned_floor();
    const Solution solution = solution_of(
        scene, 2, [](const V3f& x) { return Rgb(100 + 40 * std::sin(x.x), 100 + 40 * std::cos(x.y), 100); });
    const Lightmap lightmap = make_lightmap(scene, solution, at(50));
    const ElementVertices vertices(scene, *solution.forest);
    const SmoothField smooth(*solution.forest, vertices, solution.irradiance);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        for (std::uint64_t i = 0; i < 1000; ++i) {
            const PatchGeometry& geometry = solution.forest->geometry(p);
            const Parameters place = random_place(geometry, i);
            const Rgb expected = smooth.at(p, place), found = sample(lightmap, p, place);
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(found[k], expected[k], 0.2) << p << " " << place.u << " " << place.v;
        }
}

// Two coplanar faces of one material and two objects: two charts, turned and spaced differently, of one smooth field.
TEST(Lightmap, SeamsBetweenCoplanarFacesAreBelowOnePercent) {
    Scene scene;
    const std::uint32_t material = add_material(scene, Rgb(0.5f), Rgb(0));
    scene.objects = {"", "other"};
    const PatchIndex left = add_rectangle(scene, V3f(0), V3f(2.03f, 0, 0), V3f(0, 3, 0), material);
    const PatchIndex right = add_rectangle(scene, V3f(2.03f, 0, 0), V3f(0.71f, 0, 0), V3f(0, 3, 0), material);
    scene.patches[right].object = 1;
    const Solution solution =
        solution_of(scene, 4, [](const V3f& x) { return Rgb(100 + 80 * std::sin(3 * x.y) * std::cos(2 * x.x)); });
    const Lightmap lightmap = make_lightmap(scene, solution, at(20));
    EXPECT_NE(lightmap.chart_of_patch[left], lightmap.chart_of_patch[right]);
    for (int i = 0; i <= 1000; ++i) {
        const float v = 0.001f * static_cast<float>(i);
        const float a = sample(lightmap, left, {1, v}).x, b = sample(lightmap, right, {0, v}).x;
        ASSERT_NEAR(a / b, 1, 0.01) << v;
    }
}

/// A floor of 4 x 4 m with a wall along x = 2 m, from y = 0 to `end`. @param thickness  0: a two-sided face.
Scene floor_with_wall(float thickness, float end) {
    Scene scene;
    const std::uint32_t material = add_material(scene, Rgb(0.5f), Rgb(0));
    add_rectangle(scene, V3f(0), V3f(4, 0, 0), V3f(0, 4, 0), material);
    if (thickness > 0)
        testing_support::add_box(scene, V3f(2 - thickness / 2, 0, 0), V3f(2 + thickness / 2, end, 2), material);
    else
        add_rectangle(scene, V3f(2, 0, 0), V3f(0, end, 0), V3f(0, 0, 2), material, 1, 1, true);
    return cut_at_contacts(scene);
}

struct WallCase {
    const char* name;
    float thickness, end, texels_per_metre;
};
void PrintTo(const WallCase& wall, std::ostream* out) { *out << wall.name; }

class LightmapBesideWall : public testing::TestWithParam<WallCase> {};

// 1000 lx on one side of a wall, 1 lx on the other. A texel that mixed the sides would show hundreds of lux beside the
// wall. Fails without find_conflicts(), and with SmoothField across contacts.
TEST_P(LightmapBesideWall, LeaksNoLight) {
    const auto& [name, thickness, end, texels_per_metre] = GetParam();
    const Scene scene = floor_with_wall(thickness, end);
    const Solution solution = solution_of(scene, 5, [](const V3f& x) { return Rgb(x.x < 2 ? 1000.0f : 1.0f); });
    const Lightmap lightmap = make_lightmap(scene, solution, at(texels_per_metre));
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const PatchGeometry& geometry = solution.forest->geometry(p);
        if (geometry.normal().z < 0.9f || geometry.centre().z > 0.1f) continue;  // not part of the floor
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const Parameters place = random_place(geometry, i);
            const V3f x = geometry.point(place);
            if (x.y > end - 0.5f || std::abs(geometry.centre().x - 2) < thickness) continue;
            const float expected = geometry.centre().x < 2 ? 1000 : 1;
            ASSERT_NEAR(sample(lightmap, p, place).x / expected, 1, 1e-3) << x;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Walls, LightmapBesideWall,
                         testing::Values(WallCase{"Through", 0.01f, 4, 20}, WallCase{"ThroughCoarse", 0.01f, 4, 5},
                                         WallCase{"Free", 0.01f, 3, 20}, WallCase{"FreeCoarse", 0.01f, 3, 5},
                                         WallCase{"FreeThin", 0, 3, 20}, WallCase{"FreeThick", 0.12f, 3, 20}),
                         testing::PrintToStringParamName());

struct TwoRooms {
    const char* name;
    TwoRoomsOptions options;
};
void PrintTo(const TwoRooms& rooms, std::ostream* out) { *out << rooms.name; }

class SealedRoomsLightmap : public testing::TestWithParam<TwoRooms> {};

// Two solved rooms on both sides of a wall 1 cm thick; one is sealed and dark. Light there in excess of smooth shading
// leaked through texels.
TEST_P(SealedRoomsLightmap, LeaksNoLight) {
    const Scene scene = cut_at_contacts(make_two_rooms(GetParam().options));
    const Solution solution =
        solve(scene, RayCaster(scene), {.method = find_method("hsrr"), .limits = {.rays = 300'000}});
    const Lightmap lightmap = make_lightmap(scene, solution, at(10));
    const ElementVertices vertices(scene, *solution.forest);
    const SmoothField smooth(*solution.forest, vertices, solution.irradiance);
    const float radians = GetParam().options.turn * std::numbers::pi_v<float> / 180;
    const V3f across(std::cos(radians), std::sin(radians), 0);
    double lit = 0, dark = 0, of_smooth_shading = 0;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const PatchGeometry& geometry = solution.forest->geometry(p);
        if (lightmap.chart_of_patch[p] == none) {
            EXPECT_LT(geometry.area(), 2) << "only parts inside the wall and the cabinets are left out";
            continue;
        }
        for (std::uint64_t i = 0; i < 200; ++i) {
            const Parameters place = random_place(geometry, i);
            const V3f x = geometry.point(place);
            const float found = sample(lightmap, p, place).x;
            if ((x - V3f(4, 2, 0)).dot(across) < 0.005f) {  // the middle of the wall
                lit += found * geometry.area();
            } else {
                dark += found * geometry.area();
                of_smooth_shading += smooth.at(p, place).x * geometry.area();
            }
        }
    }
    EXPECT_GT(lit, 0);
    EXPECT_LT((dark - of_smooth_shading) / lit, 1e-4);
}

// The same, with rays at every texel. Seen to fail when records of indirect light reach across contacts.
TEST_P(SealedRoomsLightmap, LeaksNoLightWithHybridShading) {
    RELEASE_ONLY();  // see SampledLightmap.HasLightAtBordersAsAnywhere
    const Scene scene = cut_at_contacts(make_two_rooms(GetParam().options));
    const Solution solution =
        solve(scene, RayCaster(scene), {.method = find_method("hsrr"), .limits = {.rays = 300'000}});
    ExportOptions options = at(10);
    options.bake.shading = Shading::hybrid;
    const Lightmap lightmap = make_lightmap(scene, solution, options);
    const float radians = GetParam().options.turn * std::numbers::pi_v<float> / 180;
    const V3f across(std::cos(radians), std::sin(radians), 0);
    double lit = 0, dark = 0;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        if (lightmap.chart_of_patch[p] == none) continue;
        const PatchGeometry& geometry = solution.forest->geometry(p);
        for (std::uint64_t i = 0; i < 50; ++i) {
            const Parameters place = random_place(geometry, i);
            const bool is_lit = (geometry.point(place) - V3f(4, 2, 0)).dot(across) < 0.005f;
            (is_lit ? lit : dark) += sample(lightmap, p, place).x * geometry.area();
        }
    }
    EXPECT_GT(lit, 0);
    EXPECT_LT(dark / lit, 1e-3) << "rays between rounded vertices";
}

INSTANTIATE_TEST_SUITE_P(Walls, SealedRoomsLightmap,
                         testing::Values(TwoRooms{"Straight", {}}, TwoRooms{"Turned", {.turn = 30}},
                                         TwoRooms{"TurnedAndFurnished", {.turn = 30, .furniture = true}}),
                         testing::PrintToStringParamName());

class LightmapOfGroups : public testing::TestWithParam<std::tuple<Shading, LightmapContent>> {};

TEST_P(LightmapOfGroups, SumsToTheTotal) {
    const auto [shading, content] = GetParam();
    Scene scene = closed_box(V3f(1, 1.5f, 2), 1, {{"white", Rgb(0.5f), Rgb(0)}});
    scene.materials.push_back({"left", Rgb(0.5f), Rgb(2, 1, 0.5f)});
    scene.materials.push_back({"right", Rgb(0.5f), Rgb(0.5f, 1, 3)});
    scene.patches[0].material = 1;
    scene.patches[1].material = 2;
    scene.light_groups = {{"a", "left"}, {"b", "right"}};
    const Solution solution =
        solve(scene, RayCaster(scene), {.method = find_method("hsrr"), .limits = {.rays = 50'000}});
    ASSERT_EQ(solution.group_names, (std::vector<std::string>{"a", "b"}));
    ExportOptions options = at(4);
    options.bake.shading = shading;
    options.lightmap->content = content;
    const Lightmap total = make_lightmap(scene, solution, options);
    options.lightmap->groups = true;
    const Lightmap lightmap = make_lightmap(scene, solution, options);
    ASSERT_EQ(lightmap.groups.size(), 2u);
    ASSERT_EQ(lightmap.images.size(), total.images.size());
    double difference = 0, sum = 0;
    for (std::size_t page = 0; page < total.images.size(); ++page)
        for (std::size_t i = 0; i < total.images[page].pixels.size(); ++i) {
            const Rgb& texel = lightmap.images[page].pixels[i];
            const Rgb of_groups = lightmap.groups[0][page].pixels[i] + lightmap.groups[1][page].pixels[i];
            for (int k = 0; k < 3; ++k) ASSERT_FLOAT_EQ(texel[k], of_groups[k]);
            EXPECT_LE(lightmap.groups[0][page].pixels[i].z, texel.z);
            difference += channel_sum(texel - total.images[page].pixels[i]);
            sum += channel_sum(total.images[page].pixels[i]);
        }
    EXPECT_NEAR(difference / sum, 0, shading == Shading::smooth ? 1e-5 : 0.02);
    EXPECT_GT(lightmap.groups[0][0].pixels[0].x, 0);
}

INSTANTIATE_TEST_SUITE_P(All, LightmapOfGroups,
                         testing::Combine(testing::Values(Shading::smooth, Shading::gather, Shading::hybrid),
                                          testing::Values(LightmapContent::irradiance, LightmapContent::radiance)),
                         testing_support::printed_name);

/// Each texel has (M + rho H) / pi. Seen to fail without 1 / pi.
TEST(Lightmap, OfRadianceHasTheLightThatLeavesTheSurface) {
    const Rgb reflectance(0.5f, 0.25f, 0.1f), exitance(2, 1, 4), irradiance(3);
    const Scene scene = closed_box(V3f(1), 1, {{"lamp", reflectance, exitance}});
    ExportOptions options = at(4);
    options.lightmap->content = LightmapContent::radiance;
    const Lightmap lightmap = make_lightmap(scene, uniform(scene, irradiance.x), options);
    const Rgb expected = (exitance + reflectance * irradiance) / std::numbers::pi_v<float>;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const Rgb found = sample(lightmap, p, {0.4f, 0.3f});
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5f);
    }
}

/// Both images of a grey ramp, which extends ten stops beyond the scale, give its irradiance. Half a step of 8 bits is
/// 0.45% of the brightest texels. Seen to fail if gains are computed in 256 steps.
TEST(LightmapImages, TexelsTimesTheirGainsAreTheIrradiance) {
    constexpr int texels = 64;
    const float most = 8 * std::numbers::pi_v<float>;  // scale of exposure 0
    BakedImages baked;
    Image& ramp = baked.images.emplace_back(texels, 1);
    for (int i = 0; i < texels; ++i)
        ramp.at(i, 0) = Rgb(most * std::exp2(10 * static_cast<float>(i + 1) / static_cast<float>(texels)));
    GltfDocument document;
    const LightmapImages images = add_lightmap_images(document, "lit.glb", baked, {}, at(1));
    EXPECT_FLOAT_EQ(images.encoding.scale, most);
    const std::string glb = document.glb();
    const auto read = [&](int texture) {
        const Json& json = document.json;
        const Json& view =
            json["bufferViews"]
                [json["images"][json["textures"][texture]["source"].get<int>()]["bufferView"].get<int>()];
        constexpr std::size_t header = 12, chunk_header = 8;
        std::uint32_t json_bytes = 0;
        std::memcpy(&json_bytes, glb.data() + header, sizeof json_bytes);
        const std::size_t begin = header + 2 * chunk_header + json_bytes + view["byteOffset"].get<std::size_t>();
        return codecs::decode_png(std::string_view(glb).substr(begin, view["byteLength"].get<std::size_t>()), texels);
    };
    const Image stored = read(images.textures[0]), gains = read(images.gains[0]);
    for (int i = 0; i < texels; ++i) {
        const float gain = std::exp2(images.stops * srgb_encode(gains.at(i, 0).x));
        EXPECT_NEAR(stored.at(i, 0).x * gain * images.encoding.scale / ramp.at(i, 0).x, 1, 0.005) << i;
    }
}

class SampledLightmap : public testing::TestWithParam<Shading> {};
INSTANTIATE_TEST_SUITE_P(Shading, SampledLightmap, testing::Values(Shading::gather, Shading::hybrid),
                         testing_support::printed_name);

// Closed box, exitance M and reflectance rho everywhere: H = M / (1 - rho) at every point. Every texel finds this
// value, also in corners. Rays that started beyond a wall would escape, and those texels would lose half.
TEST_P(SampledLightmap, HasLightAtBordersAsAnywhere) {
    constexpr float exitance = 2, reflectance = 0.5f, expected = exitance / (1 - reflectance);
    Scene scene = closed_box(V3f(1, 1.5f, 2), 1, {{"lamp", Rgb(reflectance), Rgb(exitance)}});
    const Imath::Eulerf turn(0.3f, 0.5f, 0.7f);  // rounds vertices to either side of the walls' planes
    for (V3f& vertex : scene.vertices) vertex = vertex * turn.toMatrix33();
    ExportOptions options = at(6);
    options.bake.shading = GetParam();
    options.bake.samples = 256;
    const Lightmap lightmap = make_lightmap(scene, uniform(scene, expected), options);
    for (const LightmapChart& chart : lightmap.charts)
        for (int row = -2; row < chart.rows + 2; ++row)
            for (int column = -2; column < chart.columns + 2; ++column) {
                const Image& image = lightmap.images[static_cast<std::size_t>(chart.page)];
                ASSERT_NEAR(image.at(chart.left + column, chart.top + row).x, expected, 0.1f * expected);
            }
}

/// A strip with two columns of texels, on its borders, and a lamp above one border. Each has the light of its half of
/// the strip. Seen to fail if points beyond the border are moved to the border (+37%). The narrow strip, such as the
/// edge of a board, was seen to fail (31%) if the distance of ray starts from the border follows the longer side of
/// texels.
class TwoColumns : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(OfWidth, TwoColumns, testing::Values(0.2f, 0.012f),
                         [](const auto& tested) { return tested.index == 0 ? "20cm" : "12mm"; });

TEST_P(TwoColumns, HaveTheMeansOfTheirHalves) {
    const float width = GetParam(), height = width / 4;
    constexpr float length = 0.4f;
    constexpr int rows = 8;
    Scene scene;
    add_rectangle(scene, {0, 0, 0}, {width, 0, 0}, {0, length, 0}, add_material(scene, Rgb(0), Rgb(0)));
    scene.luminaires = {{"lamp", 0, PointLight{{0, length / 2, height}, Rgb(1)}}};
    std::array<double, 2> exact{};  // of each half
    constexpr int steps = 800;
    for (int i = 0; i < steps * steps; ++i) {
        const int column = i % steps;
        const double x = width * (column + 0.5) / steps, y = length * ((i / steps + 0.5) / steps - 0.5);
        exact[2 * column / steps] += 2 * height / std::pow(x * x + y * y + height * height, 1.5) / (steps * steps);
    }
    std::vector<BakedPoint> points;
    for (int i = 0; i < rows; ++i)
        for (const float u : {0.0f, 1.0f})
            points.push_back(
                {PatchIndex(0), {u, (static_cast<float>(i) + 0.5f) / rows}, {Parameters{1, 0}, {0, 1.0f / rows}}});
    const Solution solution = uniform(scene, 0);
    const BakeOptions options{Shading::hybrid, 4096, 1};  // in batches of 2,048
    const BakedLight light(scene, solution, options, {&DefaultSamples::texel, 0.01, false});
    const std::vector<Rgb> found = light.irradiance(points, {}, {});
    for (std::size_t column = 0; column < 2; ++column) {
        double mean = 0;
        for (std::size_t i = column; i < found.size(); i += 2) mean += static_cast<double>(found[i].x) / rows;
        EXPECT_NEAR(mean / exact[column], 1, 0.04) << "column " << column;
    }
}

/// A black floor below a dark ceiling with a window, in the light of the sky and the sun, whose shadow is sharp.
class FilteredTexels : public testing::Test {
  protected:
    static constexpr int side = 60;  // texels
    static constexpr float spacing = 4.0f / side;

    FilteredTexels() {
        add_rectangle(scene_, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, add_material(scene_, Rgb(0), Rgb(0)));
        const std::uint32_t dark = add_material(scene_, Rgb(0.02f), Rgb(0));
        for (const auto& [x, y, width, depth] : {std::array{-9.0f, -9.0f, 22.0f, 10.5f},
                                                 {-9.0f, 2.5f, 22.0f, 10.5f},
                                                 {-9.0f, 1.5f, 10.5f, 1.0f},
                                                 {2.5f, 1.5f, 10.5f, 1.0f}})
            add_rectangle(scene_, {x, y, 2}, {0, depth, 0}, {width, 0, 0}, dark, 1, 1, true);
        scene_.luminaires = {{"sky", 0, UniformSky{Rgb(100)}},
                             {"sun", 0, DirectionalLight{{0.1f, 0.2f, -1}, Rgb(100)}}};
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const auto column = static_cast<float>(i % side), row = static_cast<float>(i / side);
            points_.push_back({PatchIndex(0),
                               {(column + 0.5f) / side, (row + 0.5f) / side},
                               {Parameters{1.0f / side, 0}, {0, 1.0f / side}}});
            grid_.points.push_back(i);
        }
        solution_ = uniform(scene_, 0);
    }
    std::vector<Rgb> bake(int samples, std::uint64_t seed, bool is_filtered, double max_noise = 0.03) const {
        const BakeOptions options{Shading::hybrid, samples, seed};
        const BakedLight light(scene_, solution_, options, {&DefaultSamples::texel, max_noise, false});
        const std::span<const PointGrid> grids(&grid_, is_filtered ? 1 : 0);
        return light.irradiance(points_, grids, {});
    }
    /// Ratio of means, and relative RMSE.
    static std::array<double, 2> compare(const std::vector<Rgb>& found, const std::vector<Rgb>& exact) {
        double sum = 0, exact_sum = 0, squares = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const auto x = static_cast<double>(found[i].x), e = static_cast<double>(exact[i].x);
            sum += x;
            exact_sum += e;
            squares += (x / e - 1) * (x / e - 1);
        }
        return {sum / exact_sum, std::sqrt(squares / static_cast<double>(found.size()))};
    }

    Scene scene_;
    Solution solution_;
    std::vector<BakedPoint> points_;
    PointGrid grid_{side, {}};
};

/// Filtering halves the error; the noise of the records remains. Seen to fail without filtering, without indirect light
/// (1.9 times the error), and if both halves of the light are the same (0.76).
TEST_F(FilteredTexels, HaveLessNoiseAndTheSameMeanAndShadow) {
    RELEASE_ONLY();
    const std::vector<Rgb> exact = bake(512, 7, false, 1e-3);
    for (const std::uint64_t seed : {1, 2}) {
        const auto [noisy_mean, noisy_error] = compare(bake(16, seed, false), exact);
        const auto [mean, error] = compare(bake(16, seed, true), exact);
        EXPECT_LT(error, 0.5 * noisy_error);
        EXPECT_NEAR(mean / noisy_mean, 1, 0.002);
    }
}

}  // namespace
}  // namespace interflect
