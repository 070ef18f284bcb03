// Light sources that are not surfaces, against exact irradiances. Nothing else emits, and reflected light reaches no
// patch, so the irradiance of a patch is caused by the source alone.
//
// Seen to fail if the power of a part lacks the number of parts, a point light has 2 pi, the falloff of a spot light is
// linear, the importance of parts affects the distribution of rays but not their payload, the rays of a sky are
// uniform, the cells of a sky lack the cosine, the integral of a dome lacks a factor of pi, the rows of a map have
// equal weights, the area of a directional light is that of the top of the box, or C0 and C90 of measured light are
// exchanged.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "interflect/luminaires/emission.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "tests/support/form_factors.h"
#include "tests/support/parameter_names.h"
#include "tests/support/release_only.h"
#include "tests/support/rooms/room_with_window.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

constexpr int runs = 12;
using std::numbers::pi;

/// Returns a floor of 10 x 10 patches, 4 m x 3 m, at a height of 0.5 m. It is grey, because importance is reflected.
Scene open_floor(const Luminaire& luminaire) {
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {-1, -1, 0.5f}, {4, 0, 0}, {0, 3, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 10, 10);
    scene.luminaires = {luminaire};
    return scene;
}

/// Returns the mean of a function over a rectangular patch by the midpoint rule.
double mean_over(const Scene& scene, PatchIndex patch, const std::function<double(const V3d&)>& value) {
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
    SolveOptions options{.method = find_method(method)};
    options.method.refines = false;
    options.experimental.points = PointSet::random;
    options.limits.rays = 60'000;
    options.importance.camera_rays = 1 << 12;
    options.seed = seed;
    if (options.method.importance != ImportanceUse::off) options.views = {{view_of_floor()}};
    return options;
}

/// A kind of source, and its irradiance at a point of the floor, which faces up.
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
/// Intensity of 300 cd on the axis, straight down: full within 20 degrees, 0 beyond 50 degrees.
double spot_intensity(const V3d& x) {
    const double cosine = (lamp - x).normalized().z, inner = std::cos(20 * pi / 180), outer = std::cos(50 * pi / 180);
    const double fall = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return 300 * fall * fall;
}

/// Returns intensities of 60 cd at the nadir. At the horizon they are 0 in the C0 plane, which contains y, and 180 cd
/// in C90. They are linear in both angles.
std::shared_ptr<const PhotometricWeb> tent_web() {
    auto web = std::make_shared<PhotometricWeb>();
    web->polar = {0, 90}, web->azimuth = {0, 90, 180, 270, 360};
    web->intensities = {60, 0, 60, 180, 60, 0, 60, 180, 60, 0};
    return web;
}
double tent_intensity(const V3d& x) {
    const V3d d = x - lamp;
    const double share = std::atan2(std::hypot(d.x, d.y), -d.z) / (pi / 2),
                 to_c90 = std::atan2(std::abs(d.x), std::abs(d.y)) / (pi / 2);
    return 60 * (1 - share) + 180 * to_c90 * share;
}

/// Upper half of a map, with rows of 45 degrees. The irradiance of a horizontal surface by a texel is pi / 3 L (cos^2 -
/// cos^2), at the edges of the row.
EnvironmentMap six_texels_above_horizon() {
    std::vector<Rgb> texels;
    for (const int radiance : {10, 0, 40, 25, 90, 5, 7, 7, 7, 30, 60, 0})
        texels.emplace_back(static_cast<float>(radiance));
    return {image_of(3, 4, texels), {0, 0, 1}, {1, 1, 0}, Rgb(2)};
}
constexpr double of_six_texels = 2 * pi / 3 * (0.5 * (10 + 0 + 40) + 0.5 * (25 + 90 + 5));

std::vector<Source> sources() {
    const V3f position(lamp), slanted(1, 2, -2), zenith(0, 0, 1);
    return {{"point", {"", 0, PointLight{position, Rgb(200)}}, [](const V3d& x) { return towards_floor(x, 200); }},
            {"spot",
             {"", 0, SpotLight{position, {0, 0, -3}, Rgb(300), 20, 50}},
             [](const V3d& x) { return towards_floor(x, spot_intensity(x)); }},
            {"directional", {"", 0, DirectionalLight{slanted, Rgb(90)}}, [](const V3d&) { return 90 * 2.0 / 3; }},
            {"sky", {"", 0, UniformSky{Rgb(50)}}, [](const V3d&) { return 50 * pi; }},
            {"disc", {"", 0, DirectionalLight{slanted, Rgb(90), 20}}, [](const V3d&) { return 90 * 2.0 / 3; }},
            {"overcast",
             {"", 0, SkyDome{cie_standard_sky(1), Rgb(150), zenith, zenith, 0.5f}},
             [](const V3d&) { return 150; }},
            {"clear",
             {"", 0, SkyDome{cie_standard_sky(12), Rgb(150), zenith, -slanted, 0.5f}},
             [](const V3d&) { return 150; }},
            {"perez",
             {"", 0, SkyDome{perez_daylight(500, 200, 45).model, Rgb(150), zenith, {0, 1, 1}}},
             [](const V3d&) { return 150; }},
            {"environment", {"", 0, six_texels_above_horizon()}, [](const V3d&) { return of_six_texels; }},
            {"measured",
             {"", 0, MeasuredLight{tent_web(), position, {0, 0, -1}, {0, 1, 0}, false, Rgb(2)}},
             [](const V3d& x) { return towards_floor(x, 2 * tent_intensity(x)); }}};
}

struct SourceAndMethod {
    Source source;
    std::string method;
};
void PrintTo(const SourceAndMethod& pair, std::ostream* out) { *out << pair.source.name << '_' << pair.method; }
std::vector<SourceAndMethod> all_pairs() {
    std::vector<SourceAndMethod> pairs;
    for (const Source& source : sources())
        for (const char* method : {"srr", "ihsrr", "wdrs", "ihwdrs", "random-walk", "photon-mesh"})
            pairs.push_back({source, method});
    return pairs;
}

class LightSources : public testing::TestWithParam<SourceAndMethod> {};

TEST_P(LightSources, LightAnOpenFloor) {
    const auto& [source, method] = GetParam();
    RELEASE_ONLY_IF(source.name != "point");
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
        const double expected = mean_over(scene, PatchIndex(i), source.irradiance);
        expected_sum += expected;
        if (expected < 1e-2) continue;  // too few rays for a normal distribution
        p_values.push_back(t_test(irradiance[i], expected));
        for (std::size_t run = 0; run < runs; ++run) sums[run] += irradiance[i][run];
    }
    EXPECT_GT(p_values.size(), 50u);
    EXPECT_GT(bonferroni(p_values), false_alarm) << "expected " << expected_sum << ", found " << sums[0];
}

INSTANTIATE_TEST_SUITE_P(All, LightSources, testing::ValuesIn(all_pairs()), printed_name);

/// A lamp close to one large face, which is initially a single element. Rays leave it in all directions, and the oracle
/// must know the distance of the lamp for each: the power of an accepted ray is spread over the whole element. Seen to
/// fail if the lamp is assumed to face each ray.
TEST(PointLightNearALargeFace, IsReceivedWhereItFalls) {
    RELEASE_ONLY();
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {-1, -1, 0.5f}, {4, 0, 0}, {0, 3, 0}, add_material(scene, Rgb(0.5f), Rgb(0)));
    const V3d position(0.1, 0.4, 1.1);
    scene.luminaires = {{"", 0, PointLight{V3f(position), Rgb(200)}}};
    SolveOptions options{.method = find_method("hsrr"), .limits = {.rays = 4'000'000}};
    options.refinement.criterion = RefinementCriterion::power;
    options.experimental.epsilon = 1e-6;
    const Solution solution = solve(scene, RayCaster(scene), options);
    constexpr int blocks = 16, points = 8;
    double squares = 0;
    for (int i = 0; i < blocks; ++i)
        for (int k = 0; k < blocks; ++k) {
            double found = 0, expected = 0;
            for (int a = 0; a < points * points; ++a) {
                const double u = (i + (a / points + 0.5) / points) / blocks,
                             v = (k + (a % points + 0.5) / points) / blocks;
                const V3d d = position - V3d(-1 + 4 * u, -1 + 3 * v, 0.5);
                expected += 200 * d.z / std::pow(d.length(), 3);
                found += static_cast<double>(solution
                                                 .irradiance[solution.forest->leaf_at(
                                                     PatchIndex(0), {static_cast<float>(u), static_cast<float>(v)})]
                                                 .x);
            }
            squares += std::pow(found / expected - 1, 2) / (blocks * blocks);
        }
    EXPECT_LT(std::sqrt(squares), 0.1);
}

/// Rays that are kept give each source its share on any mesh. The mesh is much finer than necessary, and the irradiance
/// of the outer sides, which only the sky lights, is exact. Seen to fail if other leaves of a patch do not compensate
/// for leaves with too many rays.
TEST(WellDistributedRaysOnAFineMesh, GiveTheSkyItsShare) {
    RELEASE_ONLY();
    Scene scene = room_with_window(Rgb(1000));
    scene.materials[0].reflectance = Rgb(0.5f);
    SolveOptions options{.method = find_method("hwdrs"), .limits = {.rays = 200'000}};
    options.experimental.epsilon = 1e-12;
    options.refinement.min_area = 1e-6;
    const Solution solution = solve(scene, RayCaster(scene), options);
    double brightest = 0;
    for (PatchIndex i{0}; i < solution.forest->patch_count(); ++i)
        brightest = std::max(brightest, static_cast<double>(solution.irradiance[i].x));
    double sum = 0, area = 0;
    for (PatchIndex i{0}; i < solution.forest->patch_count(); ++i) {
        if (solution.irradiance[i].x < 0.9 * brightest) continue;
        sum += static_cast<double>(solution.irradiance[i].x) * solution.forest->area(i);
        area += solution.forest->area(i);
    }
    EXPECT_GT(area, 90);
    EXPECT_NEAR(sum / area / (1000 * pi), 1, 0.005);
}

TEST(UniformSkyLight, IsPiTimesRadianceToAThousandth) {
    const Scene scene = open_floor({"", 0, UniformSky{Rgb(1000)}});
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 2'000'000;
    const Solution solution = solve(scene, RayCaster(scene), options);
    double sum = 0;
    for (const Rgb& h : solution.irradiance) sum += h.x / static_cast<double>(solution.irradiance.size());
    EXPECT_NEAR(sum, 1000 * pi, 1000 * pi * 1e-3);
}

TEST(UniformSkyLight, ThroughAWindowFollowsTheFormFactor) {
    const Scene scene = room_with_window(Rgb(100));
    const RayCaster ray_caster(scene);
    std::vector<std::vector<double>> irradiance(25);
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        SolveOptions options = options_of("srr", seed);
        options.limits.rays = 400'000;
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

/// All power of the luminaires is received or escapes, up to the rounding of a float.
TEST(LightSourcesTogether, EmitWhatArrivesAndEscapes) {
    Scene scene = room_with_window(Rgb(100));
    for (const Source& source : sources()) scene.luminaires.push_back(source.luminaire);
    SolveOptions options = options_of("srr", 3);
    options.experimental.iterations = 1;
    const Solution solution = solve(scene, RayCaster(scene), options);
    const RgbD arrived = integral(*solution.forest, solution.irradiance);
    const RgbD expected = Emission(scene).total_power();
    EXPECT_NEAR((arrived.x + solution.iterations.back().escaped_power.x) / expected.x, 1, 1e-5);
    EXPECT_NEAR(solution.emitted_power.x / expected.x, 1, 1e-12);
}

}  // namespace
}  // namespace interflect
