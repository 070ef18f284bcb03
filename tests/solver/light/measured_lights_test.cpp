// Measured luminaires: irradiance of a floor, from a point and from openings of every shape that are as large as their
// distance; directions of rays.
//
// Seen to fail if C0 and C90 are exchanged, if the conditional CDF uses one of its two columns, if start points are
// uniform over the surface instead of its projection, if the ends of a cylinder are omitted, if a mirrored luminaire is
// not mirrored, or if illumination() lacks the ratio of cosines.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>

#include "interflect/luminaires/emission.h"
#include "interflect/luminaires/illumination.h"
#include "interflect/solve.h"
#include "tests/support/form_factors.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using Imath::V3d;
using Shape = LuminousOpening::Shape;

using std::numbers::pi;

/// Returns a web without symmetry, with gaps of different widths, partly dark.
std::shared_ptr<PhotometricWeb> uneven_web(PhotometricWeb::Pole pole = PhotometricWeb::Pole::nadir) {
    auto web = std::make_shared<PhotometricWeb>();
    web->pole = pole;
    web->polar = {0, 10, 35, 60, 90, 140, 180};
    web->azimuth = {-60, 0, 45, 120, 200, 300};
    for (std::size_t i = 0; i < web->azimuth.size(); ++i)
        for (std::size_t j = 0; j < web->polar.size(); ++j)
            web->intensities.push_back(i == 4 && j > 1 ? 0.0f : 100 + 40.0f * static_cast<float>((3 * i + 5 * j) % 7));
    for (std::size_t j = 0; j < web->polar.size(); ++j)
        web->intensities[5 * web->polar.size() + j] = web->intensities[j];  // 300 degrees equals -60
    return web;
}

// ---- Directions

/// Compares the numbers of rays in cells of the sphere with the flux of the web there, by Pearson's test.
void expect_directions(const PhotometricWeb& web) {
    const WebSampler sampler(web);
    EXPECT_NEAR(sampler.flux() / web.flux(), 1, 1e-12);
    constexpr int rows = 12, columns = 16, fine = 20, rays = 200'000;
    const auto cell_of = [](const V3f& d) {
        const int row = std::min(rows - 1, static_cast<int>((d.z + 1) / 2 * rows));
        const double turn = (std::atan2(d.y, d.x) + pi) / (2 * pi);
        return static_cast<std::size_t>(row * columns + std::min(columns - 1, static_cast<int>(turn * columns)));
    };
    std::vector<double> expected(rows * columns, 0), observed(rows * columns, 0);
    for (int i = 0; i < rows * fine; ++i)
        for (int k = 0; k < columns * fine; ++k) {
            const double z = (i + 0.5) / (rows * fine) * 2 - 1, r = std::sqrt(1 - z * z),
                         phi = (k + 0.5) / (columns * fine) * 2 * pi - pi;
            const V3f d(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                        static_cast<float>(z));
            expected[cell_of(d)] +=
                static_cast<double>(web.intensity(d)) / web.flux() * 4 * pi / (rows * columns * fine * fine) * rays;
        }
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < rays; ++i) {
        const V3f d = sampler.direction(uniform(random), uniform(random));
        EXPECT_NEAR(d.length(), 1, 1e-5);
        ++observed[cell_of(d)];
    }
    std::vector<double> some_expected, some_observed;
    double rest_expected = 0, rest_observed = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] < 20) {
            rest_expected += expected[i];
            rest_observed += observed[i];
            continue;
        }
        some_expected.push_back(expected[i]);
        some_observed.push_back(observed[i]);
    }
    if (rest_expected > 20) {
        some_expected.push_back(rest_expected);
        some_observed.push_back(rest_observed);
    }
    EXPECT_GT(chi_square_test(some_observed, some_expected), false_alarm);
}

TEST(WebSampler, FollowsTheIntensities) { expect_directions(*uneven_web()); }
TEST(WebSampler, FollowsTheIntensitiesOfTypeB) { expect_directions(*uneven_web(PhotometricWeb::Pole::c90)); }
TEST(WebSampler, FollowsTheIntensitiesOfAPart) {
    PhotometricWeb web = *uneven_web();
    web.azimuth.back() = 200.5f;
    web.polar.back() = 150;
    expect_directions(web);
}

// ---- Openings

struct OpeningCase {
    std::string name;
    LuminousOpening opening;
};
std::ostream& operator<<(std::ostream& out, const OpeningCase& c) { return out << c.name; }

const std::vector<OpeningCase> openings{{"rectangle", {Shape::box, {1.2f, 0.5f, 0}, 2}},
                                        {"upright_rectangle", {Shape::box, {0, 0.5f, 0.7f}, 2}},
                                        {"line", {Shape::box, {1.2f, 0, 0}, 2}},
                                        {"box", {Shape::box, {0.9f, 0.5f, 0.4f}, 2}},
                                        {"disk", {Shape::cylinder, {0.8f, 0.6f, 0}, 2}},
                                        {"cylinder", {Shape::cylinder, {0.8f, 0.6f, 0.5f}, 2}},
                                        {"tube_along_c0", {Shape::cylinder, {1.2f, 0.2f, 0.3f}, 0}},
                                        {"tube_along_c90", {Shape::cylinder, {0.2f, 1.2f, 0.3f}, 1}},
                                        {"ellipsoid", {Shape::ellipsoid, {0.9f, 0.5f, 0.7f}, 2}}};

struct SurfacePoint {
    V3d position, normal;
    double area;
};

/// Returns the surface in small pieces. A line has no pieces.
std::vector<SurfacePoint> surface_of(const LuminousOpening& o) {
    constexpr int n = 40;
    const V3d half = V3d(o.size) / 2;
    std::vector<SurfacePoint> points;
    const auto axes = [](int k) { return std::pair((k + 1) % 3, (k + 2) % 3); };
    const auto add = [&](const V3d& x, const V3d& normal_times_area) {
        const double area = normal_times_area.length();
        if (area > 0) points.push_back({x, normal_times_area / area, area});
    };
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const double u = (a + 0.5) / n, v = (b + 0.5) / n;
            for (int k = 0; k < 3 && o.shape == Shape::box; ++k)
                for (const double side : {-1.0, 1.0}) {
                    const auto [i, j] = axes(k);
                    V3d x, normal(0);
                    x[k] = side * half[k];
                    x[i] = (2 * u - 1) * half[i];
                    x[j] = (2 * v - 1) * half[j];
                    normal[k] = side * 4 * half[i] * half[j] / (n * n);
                    add(x, normal);
                }
            if (o.shape == Shape::cylinder) {
                const int k = o.axis;
                const auto [i, j] = axes(k);
                const double t = 2 * pi * u, r = std::sqrt(v);
                for (const double side : {-1.0, 1.0}) {
                    V3d x, normal(0);
                    x[k] = side * half[k];
                    x[i] = r * std::cos(t) * half[i];
                    x[j] = r * std::sin(t) * half[j];
                    normal[k] = side * pi * half[i] * half[j] / (n * n);
                    add(x, normal);
                }
                V3d x, normal(0);
                x[k] = (2 * v - 1) * half[k];
                x[i] = std::cos(t) * half[i];
                x[j] = std::sin(t) * half[j];
                normal[i] = half[j] * std::cos(t);
                normal[j] = half[i] * std::sin(t);
                add(x, normal * (4 * pi * half[k] / (n * n)));
            }
            if (o.shape == Shape::ellipsoid) {
                const double z = 2 * v - 1, r = std::sqrt(1 - z * z), t = 2 * pi * u;
                const V3d s(r * std::cos(t), r * std::sin(t), z);
                add(s * half,
                    V3d(s.x * half.y * half.z, s.y * half.z * half.x, s.z * half.x * half.y) * (4 * pi / (n * n)));
            }
        }
    return points;
}

class Openings : public testing::TestWithParam<OpeningCase> {};
INSTANTIATE_TEST_SUITE_P(All, Openings, testing::ValuesIn(openings), [](const auto& one) { return one.param.name; });

TEST_P(Openings, HaveTheAreaThatIsSeen) {
    const LuminousOpening& opening = GetParam().opening;
    for (const V3d& d : {V3d(0, 0, -1), V3d(1, 0, 0), V3d(0, 1, 0), V3d(0.3, -0.5, 0.6), V3d(-1, 2, -0.1)}) {
        double area = 0;
        for (const SurfacePoint& p : surface_of(opening)) area += p.area * std::max(0.0, p.normal.dot(d.normalized()));
        EXPECT_NEAR(projected_area(opening, V3f(d.normalized())), area, 2e-3);
    }
}

constexpr double lamp_height = 0.7;

/// Returns a luminaire above the floor, rotated so that no axis is one of the floor's.
Luminaire luminaire_with(const LuminousOpening& opening) {
    auto web = uneven_web();
    web->opening = opening;
    return {"", 0,
            MeasuredLight{
                web, {0.2f, -0.1f, static_cast<float>(lamp_height)}, {0.2f, 0.1f, -1}, {1, 0.4f, 0}, false, Rgb(2)}};
}

/// Returns the irradiance of the floor: the integral of the radiance I(d) / A(d) over the visible part of the opening.
double irradiance_from(const MeasuredLight& light, const std::vector<SurfacePoint>& surface, const V3d& x) {
    const V3d z = -V3d(light.direction).normalized(), c0 = V3d(light.c0), ex = (c0 - z * z.dot(c0)).normalized(),
              ey = z.cross(ex);
    double sum = 0;
    for (const SurfacePoint& p : surface) {
        const V3d y = V3d(light.position) + ex * p.position.x + ey * p.position.y + z * p.position.z;
        const double r = (x - y).length();
        const V3d w = (x - y) / r, d(w.dot(ex), w.dot(ey), w.dot(z));
        const double seen = p.normal.dot(d);
        if (seen <= 0 || w.z >= 0) continue;
        const double radiance = static_cast<double>(light.web->intensity(V3f(d))) *
                                static_cast<double>(light.factor.x) /
                                static_cast<double>(projected_area(light.web->opening, V3f(d)));
        sum += radiance * seen * -w.z / (r * r) * p.area;
    }
    return sum;
}

double irradiance_at(const Luminaire& luminaire, const std::vector<SurfacePoint>& surface, const V3d& x) {
    const auto& light = std::get<MeasuredLight>(luminaire.kind);
    if (!surface.empty()) return irradiance_from(light, surface, x);
    constexpr int pieces = 400;  // of a line along C0
    MeasuredLight point = light;
    auto web = std::make_shared<PhotometricWeb>(*light.web);
    web->opening = {};
    point.web = web;
    const V3f direction = LuminaireFrame(light).x;
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        const double along = ((i + 0.5) / pieces - 0.5) * static_cast<double>(light.web->opening.size.x);
        point.position = light.position + direction * static_cast<float>(along);
        const Illumination found = illumination({"", 0, point}, V3f(x));
        sum += static_cast<double>(found.irradiance.x * std::max(0.0f, found.towards.z)) / pieces;
    }
    return sum;
}

TEST_P(Openings, IlluminateAPointAsTheirSurfaceDoes) {
    const Luminaire luminaire = luminaire_with(GetParam().opening);
    const std::vector<SurfacePoint> surface = surface_of(GetParam().opening);
    for (const V3d& x : {V3d(0.2, -0.1, 0), V3d(0.9, 0.3, 0), V3d(-0.6, -0.9, 0), V3d(2.5, 1, 0)}) {
        constexpr int n = 200;
        double found = 0;
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b) {
                const Illumination i = illumination(luminaire, V3f(x), (static_cast<float>(a) + 0.5f) / n,
                                                    (static_cast<float>(b) + 0.5f) / n);
                found += static_cast<double>(i.irradiance.x * std::max(0.0f, i.towards.z)) / (n * n);
            }
        EXPECT_NEAR(found / irradiance_at(luminaire, surface, x), 1, 0.01) << x.x << ' ' << x.y;
    }
}

TEST_P(Openings, LightTheFloorBelowThem) {
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {-0.8f, -0.8f, 0}, {1.6f, 0, 0}, {0, 1.6f, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 6, 6);
    scene.luminaires = {luminaire_with(GetParam().opening)};
    const RayCaster ray_caster(scene);
    constexpr int runs = 12;
    const std::int64_t rays = is_sanitized ? 10'000 : 100'000;
    std::vector<std::vector<double>> irradiance(scene.patches.size());
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        SolveOptions options{.method = find_method("srr"), .limits = {.rays = rays}, .seed = seed};
        options.experimental.points = PointSet::random;
        const Solution solution = solve(scene, ray_caster, options);
        for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i].push_back(solution.irradiance[i].x);
    }
    RELEASE_ONLY();  // the statistics
    const std::vector<SurfacePoint> surface = surface_of(GetParam().opening);
    std::vector<double> p_values;
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        constexpr int points = 3;
        const Rectangle r = rectangles_of(scene)[i];
        double expected = 0;
        for (int k = 0; k < points * points; ++k)
            expected +=
                irradiance_at(scene.luminaires[0], surface,
                              r.corner + r.u * ((k / points + 0.5) / points) + r.v * ((k % points + 0.5) / points)) /
                (points * points);
        p_values.push_back(t_test(irradiance[i], expected, 2e-3 * expected));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

// ---- Turned luminaires

struct Turn {
    std::string name;
    V3d x, y, z;  // directions of the luminaire's axes
};
std::ostream& operator<<(std::ostream& out, const Turn& t) { return out << t.name; }

class Turned : public testing::TestWithParam<Turn> {};
INSTANTIATE_TEST_SUITE_P(All, Turned,
                         testing::Values(Turn{"not", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         Turn{"about_x", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                         Turn{"about_y", {0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
                                         Turn{"about_z", {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                         Turn{"about_all", {0.48, 0.64, -0.6}, {-0.8, 0.6, 0}, {0.36, 0.48, 0.8}},
                                         Turn{"mirrored", {1, 0, 0}, {0, -1, 0}, {0, 0, 1}}),
                         [](const auto& one) { return one.param.name; });

/// Expects E = I(theta, C) cos(theta) / r^2, averaged over each patch by the midpoint rule.
TEST_P(Turned, LightAFloorAsTheFileSays) {
    RELEASE_ONLY();
    const Turn& turn = GetParam();
    Scene scene;
    scene.objects = {""};
    add_rectangle(scene, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, add_material(scene, Rgb(0.5f), Rgb(0)), 10, 10);
    const V3d position(0.3, -0.2, 3);
    const auto web = uneven_web();
    const bool mirrored = turn.x.cross(turn.y).dot(turn.z) < 0;
    scene.luminaires = {
        {"", 0, MeasuredLight{web, V3f(position), V3f(-3.0 * turn.z), V3f(turn.x + 0.3 * turn.z), mirrored, Rgb(1)}}};
    const RayCaster ray_caster(scene);
    constexpr int runs = 12;
    std::vector<std::vector<double>> irradiance(scene.patches.size());
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const Solution solution = solve(scene, ray_caster,
                                        {.method = find_method("srr"),
                                         .limits = {.rays = 200'000},
                                         .seed = seed,
                                         .experimental = {.points = PointSet::random}});
        for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i].push_back(solution.irradiance[i].x);
    }
    std::vector<double> p_values;
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        constexpr int points = 20;
        const Rectangle r = rectangles_of(scene)[i];
        double expected = 0;
        for (int k = 0; k < points * points; ++k) {
            const V3d x = r.corner + r.u * ((k / points + 0.5) / points) + r.v * ((k % points + 0.5) / points),
                      w = x - position;
            const V3f d(V3d(w.dot(turn.x), w.dot(turn.y), w.dot(turn.z)));
            expected += static_cast<double>(web->intensity(d)) * -w.z / std::pow(w.length(), 3) / (points * points);
        }
        if (expected > 0.05) p_values.push_back(t_test(irradiance[i], expected, 1e-3 * expected));
    }
    EXPECT_GT(p_values.size(), 60u);
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

}  // namespace
}  // namespace interflect
