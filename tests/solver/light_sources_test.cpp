// Light sources that are no surfaces, against what is known exactly. Nothing else emits, and nothing that a patch
// reflects can reach another one: the irradiance of every patch is what the source alone causes there.
//
// Seen to fail when a part's power lacks the count of parts, a point light has 2 pi, a spot light's fall is linear, the
// importance of parts drives rays but is left out of what they carry, a sky's rays go out uniformly, a directional
// light's area is that of the box's top.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "interflect/luminaires/emission.h"
#include "interflect/path_tracer.h"
#include "interflect/render.h"
#include "interflect/solve.h"
#include "interflect/solver/materials.h"
#include "tests/support/form_factors.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {
namespace {

using namespace testing_support;

constexpr int runs = 12;
constexpr double pi = std::numbers::pi;

/// A floor of 10 x 10 patches, 4 m x 3 m, at the height 0.5 m; grey, as importance needs it.
Scene open_floor(const Luminaire& luminaire) {
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {-1, -1, 0.5f}, {4, 0, 0}, {0, 3, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 10, 10);
    scene.luminaires = {luminaire};
    return scene;
}

/// The mean of a function over a patch that is a rectangle, by the midpoint rule.
double mean_over(const Scene& scene, std::uint32_t patch, const std::function<double(const V3d&)>& value) {
    constexpr int points = 24;
    const Rectangle r = rectangles_of(scene)[patch];
    double sum = 0;
    for (int i = 0; i < points; ++i)
        for (int k = 0; k < points; ++k)
            sum += value(r.corner + r.u * ((i + 0.5) / points) + r.v * ((k + 0.5) / points));
    return sum / (points * points);
}

View view_of_floor() { return {"floor", {-3, -4, 3}, {1, 0.5, 0.5}, {0, 0, 1}, 40}; }

SolveOptions options_of(const std::string& method, std::uint64_t seed) {
    SolveOptions options{.method = find_method("srr")};
    options.method = find_method(method);
    options.method.refines = false;
    options.points = PointSet::random;
    options.rays = 60'000;
    options.camera_rays = 1 << 12;
    options.seed = seed;
    if (options.method.importance != ImportanceUse::off) options.views = {{view_of_floor()}};
    return options;
}

/// One kind of source, and the irradiance that it causes at a point of the floor, which faces up.
struct Source {
    std::string name;
    Luminaire luminaire;
    std::function<double(const V3d&)> irradiance;
};

const V3d lamp{0.7, 0.9, 2.5};
double towards_floor(const V3d& x, double intensity) {
    const V3d d = lamp - x;
    return intensity * d.z / std::pow(d.length(), 3);
}
/// 300 cd on the axis, straight down; full within 20 degrees, none from 50 on.
double spot_intensity(const V3d& x) {
    const double cosine = (lamp - x).normalized().z, inner = std::cos(20 * pi / 180), outer = std::cos(50 * pi / 180);
    const double fall = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return 300 * fall * fall;
}

std::vector<Source> sources() {
    const V3f position(lamp), slanted(1, 2, -2);
    return {{"point", {"", 0, PointLight{position, Rgb(200)}}, [](const V3d& x) { return towards_floor(x, 200); }},
            {"spot",
             {"", 0, SpotLight{position, {0, 0, -3}, Rgb(300), 20, 50}},
             [](const V3d& x) { return towards_floor(x, spot_intensity(x)); }},
            {"directional", {"", 0, DirectionalLight{slanted, Rgb(90)}}, [](const V3d&) { return 90 * 2.0 / 3; }},
            {"sky", {"", 0, UniformSky{Rgb(50)}}, [](const V3d&) { return 50 * pi; }}};
}

struct SourceAndMethod {
    Source source;
    std::string method;
};
std::vector<SourceAndMethod> all_pairs() {
    std::vector<SourceAndMethod> pairs;
    for (const Source& source : sources())
        for (const char* method : {"srr", "ihsrr", "wdrs", "random-walk"}) pairs.push_back({source, method});
    return pairs;
}

class LightSources : public testing::TestWithParam<SourceAndMethod> {};

TEST_P(LightSources, LightAnOpenFloor) {
    const auto& [source, method] = GetParam();
    const Scene scene = open_floor(source.luminaire);
    const RayCaster ray_caster(scene);
    std::vector<std::vector<double>> irradiance(scene.patches.size());
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution solution = solve(scene, ray_caster, options_of(method, seed));
        for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i].push_back(solution.irradiance[i].x);
    }
    std::vector<double> p_values, sums(runs, 0.0);
    double expected_sum = 0;
    for (std::uint32_t i = 0; i < irradiance.size(); ++i) {
        const double expected = mean_over(scene, i, source.irradiance);
        expected_sum += expected;
        if (expected < 1e-2) continue;  // hardly a ray arrives: not normal
        p_values.push_back(t_test(irradiance[i], expected));
        for (std::size_t run = 0; run < runs; ++run) sums[run] += irradiance[i][run];
    }
    EXPECT_GT(p_values.size(), 50u);
    EXPECT_GT(bonferroni(p_values), false_alarm) << "expected " << expected_sum << ", found " << sums[0];
}

INSTANTIATE_TEST_SUITE_P(All, LightSources, testing::ValuesIn(all_pairs()), [](const auto& test) {
    std::string name = test.param.source.name + "_" + test.param.method;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(UniformSkyLight, IsPiTimesRadianceToAThousandth) {
    const Scene scene = open_floor({"", 0, UniformSky{Rgb(1000)}});
    SolveOptions options{.method = find_method("srr")};
    options.rays = 2'000'000;
    const Solution solution = solve(scene, RayCaster(scene), options);
    double sum = 0;
    for (const Rgb& h : solution.irradiance) sum += h.x / static_cast<double>(solution.irradiance.size());
    EXPECT_NEAR(sum, 1000 * pi, 1000 * pi * 1e-3);
}

/// A black room of 5 x 4 x 3 m, open above nothing: the sky shines in through a window of 1.5 x 1.2 m in the wall x =
/// 0.
Scene room_with_window(Rgb sky) {
    Scene scene;
    scene.objects = {""};
    const std::uint32_t black = add_material(scene, Rgb(0), Rgb(0));
    const auto add = [&](V3f corner, V3f u, V3f v, int n) { add_rectangle(scene, corner, u, v, black, n, n, true); };
    add({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, 5);  // floor
    add({0, 0, 3}, {5, 0, 0}, {0, 4, 0}, 1);
    add({5, 0, 0}, {0, 4, 0}, {0, 0, 3}, 1);
    add({0, 0, 0}, {5, 0, 0}, {0, 0, 3}, 1);
    add({0, 4, 0}, {5, 0, 0}, {0, 0, 3}, 1);
    add({0, 0, 0}, {0, 1, 0}, {0, 0, 3}, 1);
    add({0, 2.5f, 0}, {0, 1.5f, 0}, {0, 0, 3}, 1);
    add({0, 1, 0}, {0, 1.5f, 0}, {0, 0, 1}, 1);
    add({0, 1, 2.2f}, {0, 1.5f, 0}, {0, 0, 0.8f}, 1);
    scene.luminaires = {{"sky", 0, UniformSky{sky}}};
    return scene;
}

TEST(UniformSkyLight, ThroughAWindowFollowsTheFormFactor) {
    const Scene scene = room_with_window(Rgb(100));
    const RayCaster ray_caster(scene);
    std::vector<std::vector<double>> irradiance(25);
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        SolveOptions options = options_of("srr", seed);
        options.rays = 400'000;
        const Solution solution = solve(scene, ray_caster, options);
        for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i].push_back(solution.irradiance[2 * i].x);
    }
    const Rectangle window{{0, 1, 1}, {0, 1.5, 0}, {0, 0, 1.2}};
    const std::vector<Rectangle> patches = rectangles_of(scene);
    std::vector<double> p_values;
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        p_values.push_back(t_test(irradiance[i], 100 * pi * form_factor(patches[2 * i], window)));
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

/// What the luminaires emit arrives or escapes, to the last bit of a float's rounding.
TEST(LightSourcesTogether, EmitWhatArrivesAndEscapes) {
    Scene scene = room_with_window(Rgb(100));
    for (const Source& source : sources()) scene.luminaires.push_back(source.luminaire);
    SolveOptions options = options_of("srr", 3);
    options.iterations = 1;
    const Solution solution = solve(scene, RayCaster(scene), options);
    const RgbD arrived = integral(*solution.forest, solution.irradiance);
    const RgbD expected = Emission(scene).total_power();
    EXPECT_NEAR((arrived.x + solution.iterations.back().escaped_power.x) / expected.x, 1, 1e-5);
    EXPECT_NEAR(solution.emitted_power.x / expected.x, 1, 1e-12);
}

/// A room with a window, a lamp in it, a spot light and the Sun: with the hierarchy and importance, mean and blocks of
/// the picture agree with path tracing.
TEST(LightSourcesTogether, AgreeWithPathTracing) {
    Scene scene = room_with_window({300, 350, 420});
    scene.materials[0].reflectance = {0.6f, 0.5f, 0.4f};
    scene.luminaires.push_back({"lamp", 0, PointLight{{3.1f, 2.2f, 2.4f}, {60, 60, 40}}});
    scene.luminaires.push_back({"spot", 0, SpotLight{{4, 1, 2.9f}, {-1, 0.5f, -2}, {200, 100, 100}, 15, 35}});
    scene.luminaires.push_back({"sun", 0, DirectionalLight{{2, 0.3f, -1}, {2000, 1900, 1500}}});
    const RayCaster ray_caster(scene);
    const View view{"room", {4.7, 3.7, 1.6}, {0.5, 1.2, 0.9}, {0, 0, 1}, 70};
    SolveOptions options{.method = find_method("srr")};
    options.method = find_method("ihsrr");
    options.views = {{view, 1, 1.5f, 48}};
    options.rays = 4'000'000;
    const Solution solution = solve(scene, ray_caster, options);
    RenderOptions picture;
    picture.width = 72, picture.height = 48;
    const Image found = render(scene, *solution.forest, ray_caster, view, solution.irradiance, picture).image;
    PathOptions paths;
    paths.width = 72, paths.height = 48;
    paths.samples = 512;
    const PathTracing traced = trace_paths(scene, ray_caster, view, paths, {});
    constexpr int blocks = 6;
    std::vector<double> mine(blocks * blocks, 0), reference(blocks * blocks, 0);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 72; ++x) {
            const auto block = static_cast<std::size_t>(y * blocks / 48 * blocks + x * blocks / 72);
            const auto pixel = static_cast<std::size_t>(y * 72 + x);
            mine[block] += luminance(found.pixels[pixel]);
            reference[block] += luminance(traced.image.pixels[pixel]);
        }
    double sum = 0, expected = 0, squares = 0;
    for (std::size_t i = 0; i < mine.size(); ++i) {
        sum += mine[i], expected += reference[i];
        squares += std::pow(mine[i] / reference[i] - 1, 2) / static_cast<double>(mine.size());
    }
    EXPECT_NEAR(sum / expected, 1, 0.01);
    EXPECT_LT(std::sqrt(squares), 0.04);
}

}  // namespace
}  // namespace interflect
