// Hybrid shading: direct light of each pixel, indirect light interpolated between records.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/geometry/polygons/polygon.h"
#include "interflect/measure.h"
#include "interflect/prepare.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/render/gauges/gauge_light.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/solve.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"
#include "tests/support/scenes/textured_scenes.h"
#include "tests/support/shadings.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

using std::numbers::pi;

double mean_radiance(const Image& image) {
    double sum = 0;
    for (const Rgb& pixel : image.pixels) sum += channel_sum(RgbD(pixel)) / 3;
    return sum / static_cast<double>(image.pixels.size());
}

/// The form factor of a small surface to a rectangle with a corner above it, C-1 of Howell's catalogue.
double to_corner_above(double a, double b, double height) {
    const double x = a / height, y = b / height, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
    return (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / (2 * std::numbers::pi);
}

TEST(PolygonIrradiance, OfARectangleAbove) {
    const std::array<V3f, 4> above{V3f(0, 0, 2), V3f(3, 0, 2), V3f(3, 1, 2), V3f(0, 1, 2)};
    const double expected = std::numbers::pi * to_corner_above(3, 1, 2);
    EXPECT_NEAR(polygon_irradiance(above, V3f(0), V3f(0, 0, 1)), expected, 1e-5);
    EXPECT_EQ(polygon_irradiance(above, V3f(0), V3f(0, 0, -1)), 0);
}

/// A wall that is high, deep and wide: half of its part above the surface fills half of the hemisphere.
TEST(PolygonIrradiance, OfAWallThatContinuesBelowTheSurface) {
    constexpr float far = 1e4f;
    const std::array<V3f, 4> wall{V3f(1, -far, -far), V3f(1, far, -far), V3f(1, far, far), V3f(1, -far, far)};
    EXPECT_NEAR(polygon_irradiance(wall, V3f(0), V3f(0, 0, 1)), pi / 2, 1e-3);
}

/// Cuts off one corner: five remain. The same as the sum of its two triangles.
TEST(PolygonIrradiance, OfARectangleWithOneCornerBelow) {
    const V3f a(1, 0, -0.2f), b(1, 2, 1), c(1, 1.5f, 3), d(1, -1, 1), n(0, 0, 1);
    const float sum =
        polygon_irradiance(std::array{a, b, c}, V3f(0), n) + polygon_irradiance(std::array{a, c, d}, V3f(0), n);
    EXPECT_NEAR(polygon_irradiance(std::array{a, b, c, d}, V3f(0), n), sum, 1e-5);
}

/// A room of 4 x 3 x 2.5 m without light, and a block in a corner.
Scene room() {
    Scene scene = closed_box({4, 3, 2.5f}, 2, {Material{"", {0.7f, 0.6f, 0.5f}}});
    add_box(scene, {0.1f, 0.1f, 0}, {0.9f, 0.7f, 0.8f}, add_material(scene, {0.5f, 0.35f, 0.2f}, Rgb(0)));
    return scene;
}
const View into_boxes{"corner", {3.6, 2.7, 1.6}, {0.4, 0.3, 0.5}, {0, 0, 1}, 60};

/// Faces down; black above. Without a back, path tracing would see the floor through the lamp from the ceiling, but
/// light from the floor would not reach the ceiling.
void add_panel(Scene& scene, const V3f& corner, float u, float v, std::uint32_t material, int divisions = 1) {
    add_rectangle(scene, corner, {0, v, 0}, {u, 0, 0}, material, divisions, divisions);
    add_rectangle(scene, corner, {u, 0, 0}, {0, v, 0}, add_material(scene, Rgb(0), Rgb(0)));
}

void add_lamp(Scene& scene, float side) {
    add_panel(scene, {1, 1, 2.45f}, side, side, add_material(scene, Rgb(0), Rgb(3000, 2800, 2000)));
}

/// The room without a roof. Its faces are two-sided: light from outside would pass one-sided walls.
Scene court(decltype(Luminaire::kind) sky) {
    Scene scene;
    const std::uint32_t wall = add_material(scene, {0.7f, 0.6f, 0.5f}, Rgb(0));
    const V3f x(4, 0, 0), y(0, 3, 0), z(0, 0, 2.5f);
    add_rectangle(scene, {0, 0, 0}, x, y, wall, 2, 2, true);
    for (const V3f& corner : {V3f(0), y}) add_rectangle(scene, corner, x, z, wall, 2, 2, true);
    for (const V3f& corner : {V3f(0), x}) add_rectangle(scene, corner, y, z, wall, 2, 2, true);
    add_box(scene, {0.1f, 0.1f, 0}, {0.9f, 0.7f, 0.8f}, wall);
    scene.luminaires.push_back({"sky", 0, std::move(sky)});
    return scene;
}

struct LitScene {
    std::string name;
    Scene scene;
    View view = into_boxes;
};
void PrintTo(const LitScene& lit, std::ostream* out) { *out << lit.name; }

std::vector<LitScene> lit_scenes() {
    std::vector<LitScene> all;
    Scene lamps = room();
    add_lamp(lamps, 0.6f);
    const std::uint32_t grey = add_material(lamps, Rgb(0.5f), Rgb(9000));
    add_panel(lamps, {0.2f, 0.2f, 1}, 0.3f, 0.2f, grey);  // near a wall
    all.push_back({"AreaLights", lamps});
    Scene points = room();
    points.luminaires.push_back({"spot", 0, SpotLight{{3, 2, 2.3f}, {-1, -0.4f, -2}, {300, 300, 200}, 15, 30}});
    points.luminaires.push_back({"point", 0, PointLight{{2, 0.5f, 2}, {50, 60, 70}}});
    all.push_back({"PointAndSpot", points});
    DirectionalLight sun{{-1, -0.5f, -2}, Rgb(1000)};
    sun.diameter = 2;
    all.push_back({"SunWithDisc", court(sun)});
    all.push_back({"UniformSky", court(UniformSky{Rgb(100)})});
    all.push_back({"ClearSky", court(known_skies().front().luminaire.kind)});
    all.push_back(
        {"TexturedEmitter", half_dark_floor(Halves::emit), {"along", {3.8, 1, 1.8}, {0.5, 1, 0.5}, {0, 0, 1}, 60}});
    Scene glass = room();
    add_lamp(glass, 0.6f);
    const std::uint32_t pane = add_material(glass, {0.1f, 0.1f, 0.1f}, Rgb(0));
    glass.materials[pane].transmittance = {0.8f, 0.5f, 0.3f};
    add_rectangle(glass, {2, 0.05f, 0.05f}, {0, 2.9f, 0}, {0, 0, 2.4f}, pane, 1, 1, true);
    all.push_back({"BehindAPane", glass});
    Scene many = room();  // more sources than UnoccludedLight sums
    const std::uint32_t bright = add_material(many, Rgb(0), Rgb(1500));
    add_panel(many, {0.5f, 0.5f, 2.45f}, 1.5f, 1.5f, bright, 10);
    all.push_back({"ManySources", many});
    return all;
}

class HybridScene : public testing::TestWithParam<LitScene> {};

/// Direct and indirect light have the means of path tracing. The noise of records is common to many pixels: the mean of
/// a picture varies from seed to seed by up to 0.45% (indirect) and 0.15% (direct), of which four seeds leave half;
/// path tracing varies by 0.1%. Interpolation and the solution may cause 0.3%. The probability that correct code fails
/// is 1e-3 (3.3 standard errors).
TEST_P(HybridScene, HasTheMeanOfPathTracing) {
    RELEASE_ONLY();
    constexpr double quantile = 3.3, bias = 0.003, path_error = 0.001;
    constexpr double direct_error = 0.0015, indirect_error = 0.0045;
    constexpr std::uint64_t seeds = 4;
    const Scene& scene = GetParam().scene;
    const RayCaster ray_caster(scene);
    PictureOptions options{.width = 64, .height = 48, .samples = 512};
    const Rendering reference = render(scene, ray_caster, GetParam().view, by(Shading::path, options));
    options.samples = 16;
    double direct = 0, indirect = 0;
    for (options.seed = 2; options.seed < 2 + seeds; ++options.seed) {
        SolveOptions solving{.method = find_method("hsrr"), .limits = {.rays = 1'000'000}};
        solving.seed = options.seed;
        const Solution solution = solve(scene, ray_caster, solving);
        const Rendering hybrid = render(scene, solution, ray_caster, GetParam().view, by(Shading::hybrid, options));
        direct += mean_radiance(hybrid.layers.reflected.direct) / seeds;
        indirect += mean_radiance(hybrid.layers.reflected.indirect) / seeds;
        EXPECT_EQ(hybrid.non_finite_pixels, 0);
    }
    const SampledLight& expected = reference.layers.reflected;
    const auto tolerance = [](double of_seed) {
        return bias + quantile * std::hypot(of_seed / std::sqrt(static_cast<double>(seeds)), path_error);
    };
    EXPECT_NEAR(direct / mean_radiance(expected.direct), 1, tolerance(direct_error));
    EXPECT_NEAR(indirect / mean_radiance(expected.indirect), 1, tolerance(indirect_error));
}

INSTANTIATE_TEST_SUITE_P(Scenes, HybridScene, testing::ValuesIn(lit_scenes()), testing::PrintToStringParamName());

/// In a furnace with exitance M and reflectance rho, irradiance is H = M / (1 - rho) and indirect irradiance rho H at
/// every point. Every other picture shows radiance: irradiance times rho / pi. Seen to fail when records count emitted
/// light, omit the reflectance, or lose 2% of their light. Fails for most seeds if paths also sample places of usual
/// radiosity.
TEST(Hybrid, FindsTheIndirectLightOfAFurnace) {
    const Scene scene = closed_box({4, 3, 2.5f}, 3, {Material{"", Rgb(0.6f), Rgb(40)}});
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 1'000'000}});
    PictureOptions options{.width = 40, .height = 30, .samples = 16};
    for (options.seed = 1; options.seed <= 4; ++options.seed) {
        const bool shows_radiance = options.seed % 2 == 0;
        options.quantity = shows_radiance ? PictureQuantity::radiance : PictureQuantity::irradiance;
        const double per_irradiance = shows_radiance ? 0.6 / pi : 1;
        const Rendering hybrid = render(scene, solution, ray_caster, into_boxes, by(Shading::hybrid, options));
        double squares = 0;
        for (const Rgb& direct : hybrid.layers.reflected.direct.pixels)
            EXPECT_NEAR(static_cast<double>(direct.x) / per_irradiance, 40, 0.1);
        for (const Rgb& indirect : hybrid.layers.reflected.indirect.pixels) {
            const double irradiance = static_cast<double>(indirect.x) / per_irradiance;
            EXPECT_NEAR(irradiance, 60, 3);
            squares += std::pow(irradiance / 60 - 1, 2);
        }
        EXPECT_LT(std::sqrt(squares / static_cast<double>(hybrid.image.pixels.size())), 0.0115);
        EXPECT_NEAR(mean_radiance(hybrid.layers.reflected.indirect) / per_irradiance, 60, 0.3);
    }
}

/// A known spot on the ceiling of a dim room gives about half of the indirect light on its floor. Seen to fail when
/// the density of rays to bright places lacks the number of paths for each, or counts them twice.
TEST(Hybrid, FindsTheIndirectLightOfABrightSpot) {
    const Scene scene = closed_box({4, 3, 2.5f}, 16, {Material{"", Rgb(0.5f)}});
    const RayCaster ray_caster(scene);
    const ElementForest forest(scene, scene.patches.size());
    std::vector<Rgb> irradiance(scene.patches.size(), Rgb(1));
    const std::size_t middle_of_ceiling = 5 * 16 * 16 + 8 * 16 + 8;
    irradiance[middle_of_ceiling] = Rgb(200);
    const KnownIrradiance known{forest, irradiance, irradiance, true};
    const TracedScene traced(scene, ray_caster);
    std::vector<Gauge> gauges;
    std::vector<double> exact;
    for (std::uint64_t i = 0; i < 100; ++i) {
        const auto words = random_words(3, i);
        const V3f x(1 + 2 * unit_float(words[0]), 1 + unit_float(words[1]), 0.01f), up(0, 0, 1);
        gauges.push_back({.position = x, .normal = up, .side_u = {0.05f, 0, 0}, .side_v = {0, 0.05f, 0}});
        exact.push_back(0);
        for (std::size_t p = 0; p < scene.patches.size(); ++p) {
            std::vector<V3f> corners;
            for (const std::uint32_t v : scene.patches[p].vertices) corners.push_back(scene.vertices[v]);
            exact.back() +=
                static_cast<double>(polygon_irradiance(corners, x, up) * irradiance[p].x) * 0.5 / std::numbers::pi;
        }
    }
    double ratio = 0;
    constexpr int seeds = 4;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        PictureOptions options{.samples = 16, .quantity = PictureQuantity::irradiance};
        options.seed = seed;
        const std::vector<GaugeLight> found = hybrid_irradiance(traced, known, gauges, options, {});
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double relative = static_cast<double>(found[i].irradiance().x) / exact[i];
            EXPECT_NEAR(relative, 1, 0.1);
            ratio += relative / static_cast<double>(seeds * found.size());
        }
    }
    EXPECT_NEAR(ratio, 1, 0.01);
}

/// Adds a black ball of quadrilaterals and triangles.
void add_ball(Scene& scene, const V3f& centre, float radius) {
    constexpr std::uint32_t rings = 32, sides = 64;
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0)),
                        first = static_cast<std::uint32_t>(scene.vertices.size());
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t k = 0; k < sides; ++k) {
            const double polar = pi * i / rings, azimuth = 2 * pi * k / sides;
            scene.vertices.push_back(centre + radius * V3f(V3d(std::sin(polar) * std::cos(azimuth),
                                                               std::sin(polar) * std::sin(azimuth), -std::cos(polar))));
        }
    const auto vertex = [&](std::uint32_t i, std::uint32_t k) { return first + i * sides + k % sides; };
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t k = 0; k < sides; ++k) {
            std::vector<std::uint32_t> corners{vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1), vertex(i + 1, k)};
            if (i == 0) corners.erase(corners.begin());
            if (i == rings - 1) corners.pop_back();
            add_polygon(scene, {&corners, 1}, black, 0, false);
        }
}

/// Below a black ball that rests on the floor of an evenly lit room, indirect irradiance is pi L (1 - (R / d)^3), where
/// d is the distance from the centre of the ball. Texels of 5 cm.
class FloorBelowABall : public testing::TestWithParam<float> {
  protected:
    static constexpr float texel = 0.05f;
    const float radius = GetParam();
    const V3f contact{2, 2, 0};

    /// Returns the mean over a texel.
    double exact_at(const V3f& x) const {
        double sum = 0;
        constexpr int n = 8;  // points along a side of a texel
        for (int i = 0; i < n * n; ++i) {
            const auto offset = [&](int k) { return texel * ((static_cast<float>(k) + 0.5f) / n - 0.5f); };
            const V3f from_contact = x + V3f(offset(i % n), offset(i / n), 0) - contact;
            const double distance = std::hypot(double{from_contact.x}, double{from_contact.y}, double{radius});
            sum += 0.5 * (1 - std::pow(double{radius} / distance, 3));
        }
        return sum / (n * n);
    }
    struct Ring {
        float near, far;  // distances from the contact [m]
        double tolerance;
    };
    /// Compares the mean light of rings around the contact.
    void expect_light(bool is_filtered, const std::vector<Ring>& rings) const {
        Scene scene = closed_box({4, 4, 2.5f}, 16, {Material{"", Rgb(0.5f)}});
        add_ball(scene, contact + V3f(0, 0, radius), radius);
        const RayCaster ray_caster(scene);
        const ElementForest forest(scene, scene.patches.size());
        const std::vector<Rgb> irradiance(scene.patches.size(), Rgb(1));
        const KnownIrradiance known{forest, irradiance, irradiance, true};
        const TracedScene traced(scene, ray_caster);
        std::vector<Gauge> gauges;
        for (int i = 0; i < 40 * 40; ++i) {
            const V3f x =
                contact + texel * V3f(static_cast<float>(i % 40) - 19.5f, static_cast<float>(i / 40) - 19.5f, 0);
            const Ray down{x + V3f(0, 0, 1e-4f), {0, 0, -1}};
            Hit floor;
            ray_caster.trace({&down, 1}, {&floor, 1});
            gauges.push_back({.position = x,
                              .normal = {0, 0, 1},
                              .patch = floor.patch,
                              .side_u = {texel, 0, 0},
                              .side_v = {0, texel, 0},
                              .is_filtered = is_filtered});
        }
        constexpr std::uint64_t seeds = 8;
        std::vector<double> light(gauges.size());  // summed over the seeds
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            PictureOptions options{.samples = 16, .quantity = PictureQuantity::irradiance};
            options.seed = seed;
            const std::vector<GaugeLight> found = hybrid_irradiance(traced, known, gauges, options, {});
            for (std::size_t i = 0; i < gauges.size(); ++i) light[i] += double{found[i].irradiance().x};
        }
        for (const Ring& ring : rings) {
            double found = 0, exact = 0;
            for (std::size_t i = 0; i < gauges.size(); ++i) {
                const float distance = (gauges[i].position - contact).length();
                if (!(distance > ring.near && distance < ring.far)) continue;
                found += light[i];
                exact += seeds * exact_at(gauges[i].position);
            }
            EXPECT_NEAR(found / exact, 1, ring.tolerance) << "from " << ring.near << " to " << ring.far << " m";
        }
    }
};
INSTANTIATE_TEST_SUITE_P(OfRadius, FloorBelowABall, testing::Values(0.2f, 0.13f),
                         [](const auto& tested) { return tested.index == 0 ? "20cm" : "13cm"; });

/// Interpolated texels; the value at their centres is up to 10% below their mean. Seen to fail (1.28 and 1.22) if all
/// records reach at least 10 cm, and (1.14 and 1.11) if their least reach is min_spacings.
TEST_P(FloorBelowABall, IsDark) {
    expect_light(/*is_filtered=*/false, {{0.03f, 0.1f, 0.11}, {0.1f, 0.2f, 0.08}, {0.2f, 1, 0.02}});
}

/// Near the contact, filtered texels gather their own light.
TEST_P(FloorBelowABall, IsExactInFilteredTexels) {
    expect_light(/*is_filtered=*/true, {{0.03f, 0.1f, 0.03}, {0.1f, 0.2f, 0.05}, {0.2f, 1, 0.02}});
}

/// A bright ground in the same bake adds no noise to a room. Seen to fail (2.3 times the noise) when errors count
/// relative to the mean of all light.
TEST(Hybrid, HasEqualNoiseInARoomWithSunlitGroundOutside) {
    RELEASE_ONLY();  // see Hybrid.SunOutsideAddsNoNoise
    Scene scene = closed_box({4, 3, 2.5f}, 4, {Material{"", Rgb(0.5f)}});
    std::vector<Rgb> irradiance;
    for (std::size_t i = 0; i < scene.patches.size(); ++i) irradiance.emplace_back(i % 2 == 0 ? 1.8f : 0.2f);
    const PatchIndex ground = add_rectangle(scene, {100, 0, 0}, {50, 0, 0}, {0, 50, 0}, 0, 1, 1);
    irradiance.emplace_back(1e6f);
    const RayCaster ray_caster(scene);
    const ElementForest forest(scene, scene.patches.size());
    const KnownIrradiance known{forest, irradiance, irradiance, true};
    const TracedScene traced(scene, ray_caster);
    constexpr float texel = 0.005f;
    const auto texel_at = [](float x, float y, PatchIndex patch) {
        return Gauge{.position = {x, y, 0.01f}, .patch = patch, .side_u = {texel, 0, 0}, .side_v = {0, texel, 0}};
    };
    std::vector<Gauge> inside;
    for (int i = 0; i < 400; ++i)
        inside.push_back(
            texel_at(1 + 0.1f * static_cast<float>(i % 20), 1 + 0.05f * static_cast<float>(i / 20), no_patch));
    std::vector<Gauge> everywhere = inside;
    for (int i = 0; i < 20; ++i) everywhere.push_back(texel_at(101 + 2 * static_cast<float>(i), 20, ground));
    const auto noise_inside = [&](const std::vector<Gauge>& gauges) {
        std::vector<GaugeLight> found[2];
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            PictureOptions options{.samples = 16, .quantity = PictureQuantity::irradiance};
            options.seed = seed;
            found[seed] = hybrid_irradiance(traced, known, gauges, options, {});
        }
        double squares = 0;
        for (std::size_t i = 0; i < inside.size(); ++i)
            squares += std::pow(found[0][i].irradiance().x - found[1][i].irradiance().x, 2);
        return std::sqrt(squares / static_cast<double>(inside.size()));
    };
    const double alone = noise_inside(inside);
    EXPECT_GT(alone, 0);
    EXPECT_LT(noise_inside(everywhere), 1.4 * alone);
}

/// Indirect light beside a sunlit crate without a sky, where most rays of records escape: in the mean of twelve
/// solutions as by path tracing, within 15% of the mean. Records blur the steep change at the foot, by up to 6%; one
/// solution has a standard deviation of 11%. Seen to fail (-57%) when escaped rays extend the reach of records.
TEST(Hybrid, FindsTheIndirectLightInTheShadowOfACrate) {
    RELEASE_ONLY();  // see Hybrid.SunOutsideAddsNoNoise
    Scene scene;
    scene.objects = {""};
    const std::uint32_t ground = add_material(scene, Rgb(0.4f), Rgb(0));
    add_rectangle(scene, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, ground, 40, 40);
    add_box(scene, {0, 0, 0}, {1, 1.4f, 0.9f}, add_material(scene, Rgb(0.7f), Rgb(0)));
    add_box(scene, {-1.6f, 0.1f, 0}, {-0.8f, 0.9f, 1.1f}, 1);
    scene.luminaires.push_back({"sun", 0, DirectionalLight{{0.8f, 0.1f, -0.9f}, Rgb(10'000)}});
    scene = cut_at_contacts(std::move(scene));
    const RayCaster ray_caster(scene);
    std::vector<MeasuringPoint> points;
    std::vector<Gauge> gauges;
    for (int i = 0; i < 12; ++i) {
        const V3f x(1.02f + 0.05f * static_cast<float>(i), 0.6f, 1e-4f), up(0, 0, 1);
        points.push_back({Imath::V3d(x), up});
        gauges.push_back({.position = x, .normal = up, .side_u = {0.04f, 0, 0}, .side_v = {0, 0.04f, 0}});
        gauges.push_back({.position = x + V3f(0.3f * static_cast<float>(i), 3, 0),
                          .normal = up,
                          .side_u = {0.04f, 0, 0},
                          .side_v = {0, 0.04f, 0}});
    }
    const TracedScene traced(scene, ray_caster);
    constexpr int solutions = 12;
    std::vector<double> found(points.size(), 0);
    for (std::uint64_t seed = 1; seed <= solutions; ++seed) {
        SolveOptions solving{.method = find_method("hsrr"), .limits = {.rays = 2'000'000}};
        PictureOptions options{.samples = 16, .quantity = PictureQuantity::irradiance};
        solving.seed = options.seed = seed;
        const Solution solution = solve(scene, ray_caster, solving);
        KnownIrradiance known = known_irradiance(scene, solution);
        known.is_interpolated = true;
        const std::vector<GaugeLight> light = hybrid_irradiance(traced, known, gauges, options, {});
        for (std::size_t i = 0; i < points.size(); ++i)
            found[i] += static_cast<double>(light[2 * i].indirect.x) / solutions;
    }
    const auto expected =
        measure_irradiance(scene, nullptr, ray_caster, points, {.shading = Shading::path, .samples = 1 << 14});
    double mean = 0;
    for (const MeasuredIrradiance& e : expected) mean += static_cast<double>(e.indirect.x) / 12;
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(found[i], expected[i].indirect.x, 0.15 * mean) << i;
}

/// Root of the mean variance relative to the squared mean of the 49 pixels around, at least the mean of the picture.
double relative_to_surroundings(const std::vector<double>& variance, const std::vector<double>& mean, int width) {
    const int height = static_cast<int>(mean.size()) / width;
    const double least = std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(mean.size());
    double sum = 0;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            double light = 0, count = 0;
            for (int y = std::max(0, row - 3); y <= std::min(height - 1, row + 3); ++y)
                for (int x = std::max(0, column - 3); x <= std::min(width - 1, column + 3); ++x) {
                    light += mean[static_cast<std::size_t>(y * width + x)];
                    ++count;
                }
            const double scale = std::max(least, light / count);
            sum += variance[static_cast<std::size_t>(row * width + column)] / (scale * scale);
        }
    return std::sqrt(sum / static_cast<double>(mean.size()));
}

/// Light through a gap of 2 cm below a door is rare: few samples find it. The stated error is the true one, which the
/// difference of two pictures tells. Seen to fail (0.1) when errors are relative to the noisy value of the pixel.
TEST(Hybrid, StatesTheErrorOfRareLight) {
    RELEASE_ONLY();  // see Hybrid.SunOutsideAddsNoNoise
    Scene scene;
    scene.objects = {""};
    const std::uint32_t wall = add_material(scene, Rgb(0.5f), Rgb(0));
    add_rectangle(scene, {0, 0, 0}, {6, 0, 0}, {0, 3, 0}, wall, 4, 2, true);
    add_rectangle(scene, {0, 0, 2.5f}, {6, 0, 0}, {0, 3, 0}, wall, 4, 2, true);
    for (const float y : {0.0f, 3.0f}) add_rectangle(scene, {0, y, 0}, {6, 0, 0}, {0, 0, 2.5f}, wall, 4, 2, true);
    for (const float x : {0.0f, 6.0f}) add_rectangle(scene, {x, 0, 0}, {0, 3, 0}, {0, 0, 2.5f}, wall, 2, 2, true);
    add_rectangle(scene, {3, 0, 0.02f}, {0, 3, 0}, {0, 0, 2.48f}, wall, 2, 2, true);
    add_panel(scene, {0.5f, 0.5f, 2.45f}, 1.2f, 2, add_material(scene, Rgb(0), Rgb(5000)));
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 1'000'000}});
    const View view{"dark room", {5.7, 0.4, 1.6}, {3.4, 2, 0.3}, {0, 0, 1}, 60};
    constexpr std::uint64_t pictures = 8;
    std::vector<Rendering> seen;
    for (std::uint64_t seed = 1; seed <= pictures; ++seed)
        seen.push_back(
            render(scene, solution, ray_caster, view, {.width = 96, .height = 54, .samples = 16, .seed = seed}));
    const std::size_t pixels = seen[0].image.pixels.size();
    std::vector<double> mean(pixels), variance(pixels);  // of a picture
    double stated = 0, actual = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        for (const Rendering& r : seen) mean[i] += channel_sum(RgbD(r.image.pixels[i])) / pictures;
        for (const Rendering& r : seen) {
            variance[i] += std::pow(channel_sum(RgbD(r.image.pixels[i])) - mean[i], 2) / (pictures - 1);
            stated += std::pow(channel_sum(RgbD(r.standard_error.pixels[i])), 2) / pictures;
        }
        actual += variance[i];
    }
    EXPECT_GT(std::sqrt(stated / actual), 0.7);
    EXPECT_LT(std::sqrt(stated / actual), 1.4);
    // The command's number is relative to the light around each pixel, at least the mean of the picture.
    double relative = 0;
    for (const Rendering& r : seen) relative += r.relative_error / pictures;
    EXPECT_NEAR(relative / relative_to_surroundings(variance, mean, 96), 1, 0.4);
}

/// A lamp that covers parts of four pixels is a thousand times brighter than the walls. The pixels at its edges are
/// about as wrong as they are bright, and all others exact. Seen to fail (59%) when only the pixels around are the
/// scale.
TEST(Hybrid, StatesTheErrorOfASmallLampRelativeToTheLamp) {
    Scene scene = closed_box({4, 3, 2.5f}, 1, {Material{"", Rgb(0), Rgb(10)}});
    const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(10'000));
    add_rectangle(scene, {3.99f, 1.52f, 1.27f}, {0, 0, 0.06f}, {0, 0.06f, 0}, lamp);
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.limits = {.rays = 100'000}});
    const View view{"lamp", {0.5, 1.5, 1.25}, {4, 1.5, 1.25}, {0, 0, 1}, 60};
    const Rendering seen = render(scene, solution, ray_caster, view, {.width = 33, .height = 33, .samples = 16});
    EXPECT_GT(mean_radiance(seen.image), 1.2 * 10 / std::numbers::pi);
    // At most one of 33 x 33 pixels misses the whole light of the lamp, relative to its mean over nine.
    EXPECT_LT(seen.relative_error, 9.0 / 33);
}

/// Without occluders, direct light is exact in every pixel.
TEST(Hybrid, HasNoNoiseInDirectLightWithoutShadows) {
    Scene scene = closed_box({4, 3, 2.5f}, 1, {Material{"", Rgb(0.5f)}});
    add_lamp(scene, 0.6f);
    scene.luminaires.push_back({"point", 0, PointLight{{2, 0.5f, 2}, {50, 60, 70}}});
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("srr"), .limits = {.rays = 100'000}});
    const View down{"down", {2, 1.5, 2}, {2, 1.5, 0}, {0, 1, 0}, 50};
    PictureOptions options{.width = 32, .height = 24, .samples = 4, .quantity = PictureQuantity::irradiance};
    const Rendering few = render(scene, solution, ray_caster, down, by(Shading::hybrid, options));
    RELEASE_ONLY();  // the reference
    options.samples = 256;
    const Rendering many = render(scene, ray_caster, down, by(Shading::path, options));
    for (std::size_t i = 0; i < few.image.pixels.size(); ++i) {
        EXPECT_LT(few.layers.reflected.direct_variance[i], std::pow(0.02f * few.image.pixels[i].x, 2.0f));
        EXPECT_NEAR(few.layers.reflected.direct.pixels[i].x / many.layers.reflected.direct.pixels[i].x, 1, 0.1);
    }
    EXPECT_NEAR(mean_radiance(few.layers.reflected.direct) / mean_radiance(many.layers.reflected.direct), 1, 0.003);
}

TEST(Hybrid, SameSeedSameBits) {
    Scene scene = room();
    add_lamp(scene, 0.6f);
    const RayCaster ray_caster(scene);
    const Solution solution = solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = 100'000}});
    const PictureOptions options{.width = 80, .height = 60, .samples = 16};
    const Rendering a = render(scene, solution, ray_caster, into_boxes, by(Shading::hybrid, options));
    const Rendering b = render(scene, solution, ray_caster, into_boxes, by(Shading::hybrid, options));
    EXPECT_EQ(a.image.pixels, b.image.pixels);
}

}  // namespace
}  // namespace interflect
