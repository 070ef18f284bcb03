// Direct light: inverse-square and cosine law, measured luminaires, area sources.
//
// Seen to fail when directions of rays lack the cosine, intensities fall with 1/r, luminaires or lamps lack 1/pi in
// gathering, C0 and C90 are exchanged, 0.5% of the power is lost.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "interflect/formats/mgf/mgf.h"
#include "interflect/load.h"
#include "tests/support/scenes/scenes.h"
#include "tests/validation/cases/closed_forms.h"
#include "tests/validation/cases/placement.h"

namespace interflect {
namespace {

using namespace testing_support;

using std::numbers::pi;
constexpr double float_rounding = 2e-5;  // relative, for single precision

/// A black plate without influence, because a scene needs faces.
constexpr float depth = 10;  // [m]
Scene plate_below() {
    Scene scene;
    add_rectangle(scene, {-0.05f, -0.05f, -depth}, {0.1f, 0, 0}, {0, 0.1f, 0}, add_material(scene, Rgb(0), Rgb(0)));
    return scene;
}

/// Measuring points are this far above the requested positions [m], which is the ray offset of this scene.
constexpr double offset = 0x1p-17 * static_cast<double>(depth);

TEST(PointSource, FollowsTheInverseSquareLaw) {
    Scene scene = plate_below();
    scene.luminaires = {{"", 0, PointLight{{0, 0, 0}, Rgb(1000)}}};
    const std::vector<double> distances{0.5, 1, 2, 5, 10};
    std::vector<MeasuringPoint> points;
    for (const double r : distances) points.push_back({V3d(0.6, 0, -0.8) * r, {-0.6f, 0, 0.8f}});
    const auto found = measured(scene, points, 1000, 16);
    for (std::size_t i = 0; i < points.size(); ++i)
        check("point", "inverse-square law, 1000 cd", fmt::format("E at {} m [lx]", distances[i]),
              1000 / (distances[i] * distances[i]), found[i], float_rounding + 2 * offset / distances[i]);
}

TEST(PointSource, FollowsTheCosineLaw) {
    Scene scene = plate_below();
    scene.luminaires = {{"", 0, PointLight{{0, 0, 2}, Rgb(1000)}}};
    const std::vector<double> angles{0, 30, 60, 80, 89};
    std::vector<MeasuringPoint> points;
    for (const double angle : angles) {
        const double a = angle * pi / 180;
        points.push_back({{0, 0, 0}, {static_cast<float>(std::sin(a)), 0, static_cast<float>(std::cos(a))}});
    }
    const auto found = measured(scene, points, 1000, 16);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double cosine = std::cos(angles[i] * pi / 180);
        check("point", "cosine law, 1000 cd at 2 m", fmt::format("E, {} degrees from the normal [lx]", angles[i]),
              250 * cosine, found[i], float_rounding + offset / 2 * (3 * cosine + 1 / cosine));
    }
}

/// A floor of 4 x 3 m, and an off-centre point light at a height of 2.5 m.
struct LitFloor {
    static constexpr double intensity = 1000, height = 2.5, x = 1, y = 1.2;

    static Scene scene(int n) {
        Scene s;
        add_rectangle(s, {0, 0, 0}, {4, 0, 0}, {0, 3, 0}, add_material(s, Rgb(0), Rgb(0)), n, n);
        s.luminaires = {{"", 0, PointLight{V3f(V3d(x, y, height)), Rgb(static_cast<float>(intensity))}}};
        return s;
    }
    static double illuminance(const V3d& p) {
        return intensity * height / std::pow((p - V3d(x, y, height)).length(), 3);
    }
    static double mean() {
        const auto part = [](double a, double b) { return corner_solid_angle(a, b, height); };
        return intensity * (part(x, y) + part(4 - x, y) + part(x, 3 - y) + part(4 - x, 3 - y)) / 12;
    }
};

void check_floor(const Placement& place, int n, const std::vector<V3d>& places) {
    const Scene scene = place.scene(LitFloor::scene(n));
    std::vector<MeasuringPoint> points;
    for (const V3d& p : places) points.push_back(place.measuring_point(p, {0, 0, 1}));
    const auto found = measured(scene, points, 1000, 16);
    const double unit = place.scale * place.scale;
    const std::string name = fmt::format("floor of {}, {}", n == 1 ? "one face" : "49 faces", place.name);
    for (std::size_t i = 0; i < places.size(); ++i)
        check("point", name, fmt::format("E at ({:g}, {:g}) m [lx]", places[i].x, places[i].y),
              LitFloor::illuminance(places[i]) / unit, found[i], 1e-4);
    check("point", name, "mean E, as solved [lx]", LitFloor::mean() / unit,
          solved(scene, 0, static_cast<std::uint32_t>(n * n), 40'000), 1e-4);
}

TEST(PointSource, LightsAFloor) {
    const V3d below(1, 1.2, 0), beside(2.1, 1.7, 0), in_the_corner(3.9, 2.9, 0);
    check_floor(placements[0], 1, {below, beside, in_the_corner});
    check_floor(placements[0], 7, {below, in_the_corner});
    check_floor(placements[1], 7, {below, in_the_corner});
    check_floor(placements[2], 1, {below, in_the_corner});
    check_floor(placements[3], 1, {below, in_the_corner});
}

/// scenes/pendant.ies as in the file: intensities at C (a multiple of 45 degrees) and gamma.
struct TabulatedIntensity {
    double gamma, c, intensity;
};

/// At this distance its opening, 1.2 m long, acts as a point.
TEST(MeasuredLuminaire, HasTheIntensitiesOfItsFile) {
    const std::vector<TabulatedIntensity> table{{0, 0, 800},   {30, 0, 640},   {30, 45, 680},  {30, -45, 680},
                                                {30, 90, 740}, {50, 180, 250}, {130, 45, 260}, {140, 90, 390},
                                                {25, 45, 715}, {30, 22.5, 660}};
    constexpr double distance = 600;
    Warnings warnings;
    const auto web =
        std::make_shared<PhotometricWeb>(load_photometric_web(repository() / "scenes/pendant.ies", {}, warnings));
    for (const bool is_turned : {false, true}) {
        const std::size_t tested = is_turned ? 5 : table.size();
        Scene scene = plate_below();
        const V3d down = is_turned ? V3d(0, 1, 0) : V3d(0, 0, -1), c0(1, 0, 0), c90 = c0.cross(down);
        scene.luminaires = {{"", 0, MeasuredLight{web, {0, 0, 0}, V3f(down), V3f(c0)}}};
        std::vector<MeasuringPoint> points;
        for (std::size_t i = 0; i < tested; ++i) {
            const auto& [gamma, c, intensity] = table[i];
            const double g = gamma * pi / 180, turn = c * pi / 180;
            const V3d d = down * std::cos(g) + (c0 * std::cos(turn) + c90 * std::sin(turn)) * std::sin(g);
            points.push_back({d * distance, V3f(-d)});
        }
        const auto found = measured(scene, points, 1000, 256);
        for (std::size_t i = 0; i < tested; ++i)
            check("luminaire", is_turned ? "pendant.ies, facing along y" : "pendant.ies, facing down",
                  fmt::format("E r² at gamma = {:g}, C = {:g} [cd]", table[i].gamma, table[i].c), table[i].intensity,
                  {found[i].mean * distance * distance, found[i].standard_error * distance * distance}, 3e-4);
    }
}

/// The walls of a black room receive the whole emission: the integral of its table, by the midpoint rule.
TEST(MeasuredLuminaire, EmitsTheLumensOfItsFile) {
    Warnings warnings;
    const auto web =
        std::make_shared<PhotometricWeb>(load_photometric_web(repository() / "scenes/pendant.ies", {}, warnings));
    Scene scene = closed_box({4, 5, 3}, 1, {Material{"", Rgb(0), Rgb(0)}});
    scene.luminaires = {{"", 0, MeasuredLight{web, {2, 2.5f, 2}}}};
    constexpr int rows = 1800, columns = 360;
    double lumens = 0;
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
            const double gamma = (i + 0.5) * pi / rows, c = (k + 0.5) * 2 * pi / columns;
            const V3d d(std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c), -std::cos(gamma));
            lumens += static_cast<double>(web->intensity(V3f(d))) * std::sin(gamma) * 2 * pi * pi / (rows * columns);
        }
    const double area = 2 * (4 * 5 + 4 * 3 + 5 * 3);
    const Estimate mean = solved(scene, 0, 6, 40'000);
    check("luminaire", "pendant.ies in a black room", "flux on the walls, as solved [lm]", lumens,
          {mean.mean * area, mean.standard_error * area}, 1e-4);
}

// ---- Area sources

/// A lamp of 1 x 1.5 m, 2 m over a floor and beside a wall, each of 6 m; all other surfaces are black.
struct LampOverFloor {
    static constexpr double exitance = 5000;
    static Rectangle lamp() { return {{1, 2, 2}, {0, 1.5, 0}, {1, 0, 0}}; }
    static Rectangle floor() { return {{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}; }
    static Rectangle wall() { return {{0, 0, 0}, {0, 6, 0}, {0, 0, 6}}; }

    static Scene scene(int n) {
        Scene s;
        const std::uint32_t black = add_material(s, Rgb(0), Rgb(0));
        for (const Rectangle& r : {floor(), wall()}) add_rectangle(s, V3f(r.corner), V3f(r.u), V3f(r.v), black);
        const Rectangle r = lamp();
        add_rectangle(s, V3f(r.corner), V3f(r.u), V3f(r.v), add_material(s, Rgb(0), Rgb(static_cast<float>(exitance))),
                      n, n);
        return s;
    }
    /// Computes the illuminance on the side of the floor and the wall.
    static double illuminance(const V3d& p, const V3d& normal) {
        return exitance * std::abs(configuration_factor(p, normal, corners(lamp())));
    }
};

struct LitPlace {
    V3d position, normal;
    std::string text() const {
        return normal.z > 0 ? fmt::format("E of the floor at ({:g}, {:g}) m [lx]", position.x, position.y)
                            : fmt::format("E of the wall at ({:g}, {:g}) m [lx]", position.y, position.z);
    }
};

void check_lamp(const Placement& placement, int n, const std::vector<LitPlace>& places) {
    const Scene scene = placement.scene(LampOverFloor::scene(n));
    std::vector<MeasuringPoint> points;
    for (const LitPlace& p : places) points.push_back(placement.measuring_point(p.position, p.normal));
    const auto found = measured(scene, points, 1000, 8192);
    const std::string name = fmt::format("1 m × 1.5 m lamp of {}, {}", n == 1 ? "one face" : "9 faces", placement.name);
    for (std::size_t i = 0; i < places.size(); ++i)
        check("area", name, places[i].text(), LampOverFloor::illuminance(places[i].position, places[i].normal),
              found[i], 1e-4);
    const double to_floor = form_factor(LampOverFloor::lamp(), LampOverFloor::floor());
    check("area", name, "mean E of the floor, as solved [lx]", LampOverFloor::exitance * 1.5 / 36 * to_floor,
          solved(scene, 0, 1, 40'000), 1e-4);
}

TEST(AreaSource, OverAFloorAndBesideAWall) {
    const V3d up(0, 0, 1), across(1, 0, 0);
    const std::vector<LitPlace> places{
        {{1.5, 2.75, 0}, up}, {{1, 2, 0}, up}, {{5, 4, 0}, up}, {{0, 2.75, 1}, across}, {{0, 5, 1.9}, across}};
    check_lamp(placements[0], 1, places);
    check_lamp(placements[1], 3, {places[1], places[3]});
    check_lamp(placements[2], 1, {places[1], places[3]});
    check_lamp(placements[3], 1, {places[1], places[3]});
}

/// A black floor of 6 x 6 m.
void add_floor(Scene& scene) {
    add_rectangle(scene, {-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, add_material(scene, Rgb(0), Rgb(0)));
}

/// A disc over the middle of a floor.
struct Disc {
    static constexpr double radius = 0.5, height = 1.2, exitance = 5000;

    static double illuminance(double distance) {
        return exitance * disc_configuration_factor(radius, height, distance);
    }

    /// Reads the disc from a scene file.
    static Scene ring(int divisions) {
        const std::string text = fmt::format("m lamp =\n ed {}\n sides 1\nv c =\n p 0 0 {}\n n 0 0 -1\nring c 0 {}\n",
                                             exitance, height, radius);
        Scene scene = detail::read_mgf_text(text, "disc.mgf", {.curve_divisions = divisions});
        add_floor(scene);
        return scene;
    }

    /// The opening of a luminaire with I(gamma) = I0 cos gamma.
    static Scene luminaire() {
        Scene scene;
        add_floor(scene);
        auto web = std::make_shared<PhotometricWeb>();
        const double peak = exitance * radius * radius;  // M A / pi
        web->azimuth = {0, 360};
        for (int i = 0; i <= 180; ++i) web->polar.push_back(static_cast<float>(i) / 2);
        for (int repeat = 0; repeat < 2; ++repeat)
            for (int i = 0; i <= 180; ++i)
                web->intensities.push_back(i < 180 ? static_cast<float>(peak * std::cos(i * pi / 360)) : 0);
        const auto width = static_cast<float>(2 * radius);
        web->opening = {LuminousOpening::Shape::cylinder, {width, width, 0}, 2};
        scene.luminaires = {{"", 0, MeasuredLight{web, {0, 0, static_cast<float>(height)}}}};
        return scene;
    }
};

/// Positions on the floor [m from the axis].
const std::vector<double> disc_distances{0, 0.4, 1.5, 2.8};

V3d on_floor(double distance) { return V3d(0.6, 0.8, 0) * distance; }

TEST(AreaSource, DiscOverAFloor) {
    for (const bool is_luminaire : {false, true}) {
        const Scene scene = is_luminaire ? Disc::luminaire() : Disc::ring(ReadOptions().curve_divisions);
        std::vector<MeasuringPoint> points;
        for (const double a : disc_distances) points.push_back({on_floor(a), {0, 0, 1}});
        const auto found = measured(scene, points, 1000, 2048);
        for (std::size_t i = 0; i < points.size(); ++i)
            check("area", is_luminaire ? "disc, as the opening of a luminaire" : "disc, as a ring of 16 triangles",
                  fmt::format("E at {:g} m from the axis [lx]", disc_distances[i]),
                  Disc::illuminance(disc_distances[i]), found[i], 5e-4);
    }
}

TEST(AreaSource, DiscOfAnyNumberOfFacets) {
    for (const int divisions : {2, 3, 4, 8, 32}) {
        const Scene scene = Disc::ring(divisions);
        for (const double a : disc_distances) {
            double found = 0;
            for (const Patch& patch : scene.patches) {
                const double exitance = scene.materials[patch.material].exitance.x;
                if (exitance == 0) continue;
                std::vector<V3d> corners;
                for (int i = 0; i < patch.vertex_count(); ++i) corners.emplace_back(scene.vertices[patch.vertices[i]]);
                found += exitance * std::abs(configuration_factor(on_floor(a), {0, 0, 1}, corners));
            }
            EXPECT_NEAR(found / Disc::illuminance(a), 1, 1e-3) << divisions << " divisions, " << a << " m";
        }
    }
}

/// Checks the closed form against a catalogue's figure: a unit square seen from 1 m under a corner.
TEST(ConfigurationFactor, IsTheCataloguesFigure) {
    EXPECT_NEAR(configuration_factor({0, 0, 0}, {0, 0, 1}, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}),
                std::atan(std::sqrt(0.5)) / (pi * std::sqrt(2)), 1e-12);
}

}  // namespace
}  // namespace interflect
