// Light between surfaces: form factors, and reflection from a lit floor.
//
// Seen to fail when radiosity lacks rho, directions of rays lack the cosine, 0.5% of the power is lost.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/scenes/scenes.h"
#include "tests/validation/cases/closed_forms.h"
#include "tests/validation/cases/placement.h"

namespace interflect {
namespace {

using namespace testing_support;

struct Pair {
    std::string name;
    Rectangle from, to;
};
const std::vector<Pair> pairs{
    {"unit squares, opposite at 1 m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}},
    {"unit squares with a common edge, perpendicular",
     {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
     {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {"unit squares, opposite at 0.1 m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0.1}, {0, 1, 0}, {1, 0, 0}}},
    {"1 m × 1 m and 2 m × 3 m, opposite and shifted",
     {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
     {{0.5, -1, 0.7}, {0, 3, 0}, {2, 0, 0}}},
    {"1 m × 1 m and 3 m × 2 m, perpendicular and apart",
     {{1, 0, 0}, {1, 0, 0}, {0, 1, 0}},
     {{0, -2, 0.5}, {0, 3, 0}, {0, 0, 2}}}};

/// Form factor F from the first to the second: the share of the first one's emission that the second receives.
TEST(FormFactor, IsTheLightThatIsExchanged) {
    for (const auto& [name, from, to] : pairs)
        for (const Placement& place : placements) {
            Scene scene;
            const std::uint32_t lamp = add_material(scene, Rgb(0), Rgb(100)),
                                black = add_material(scene, Rgb(0), Rgb(0));
            add_rectangle(scene, V3f(from.corner), V3f(from.u), V3f(from.v), lamp);
            add_rectangle(scene, V3f(to.corner), V3f(to.u), V3f(to.v), black);
            const Estimate e = solved(place.scene(scene), 1, 1, 60'000);
            const double factor = to.area() / from.area() / 100;
            check("form factors", name, place.name, form_factor(from, to), {e.mean * factor, e.standard_error * factor},
                  1e-4);
        }
}

/// A floor of 2 x 2 m that reflects 0.8 of 1000 lx from a vertical sun, with a black wall beside it and a black ceiling
/// over it. The ceiling has no back, so the sun shines through it.
struct FloorLitByFace {
    static constexpr double radiosity = 800;
    static Rectangle floor() { return {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}; }
    static Rectangle wall() { return {{0, 0, 0}, {0, 2, 0}, {0, 0, 2.5}}; }
    static Rectangle ceiling() { return {{0, 0, 2.5}, {0, 2, 0}, {2, 0, 0}}; }
    /// Stands on the floor, parallel to the wall: 0.6 m from it and 0.5 m high.
    static Rectangle screen() { return {{0.6, -3, 0}, {0, 8, 0}, {0, 0, 0.5}}; }

    static Scene scene(bool has_screen) {
        Scene s;
        const std::uint32_t grey = add_material(s, Rgb(0.8f), Rgb(0)), black = add_material(s, Rgb(0), Rgb(0));
        const auto add = [&](const Rectangle& r, std::uint32_t material, bool two_sided) {
            add_rectangle(s, V3f(r.corner), V3f(r.u), V3f(r.v), material, 1, 1, two_sided);
        };
        add(floor(), grey, false);
        add(wall(), black, false);
        add(ceiling(), black, false);
        if (has_screen) add(screen(), black, true);
        s.luminaires = {{"sun", 0, DirectionalLight{{0, 0, -1}, Rgb(1000)}}};
        return s;
    }
    /// Computes the illuminance at a place from which the floor is visible between x = a and b.
    static double illuminance(const V3d& p, const V3d& normal, double a, double b) {
        return radiosity * std::abs(configuration_factor(p, normal, corners({{a, 0, 0}, {b - a, 0, 0}, {0, 2, 0}})));
    }
};

TEST(Reflection, OfALitFloor) {
    const Scene scene = FloorLitByFace::scene(false);
    const std::vector<std::pair<V3d, V3d>> places{{{0, 1, 0.25}, {1, 0, 0}},
                                                  {{0, 0.3, 1.5}, {1, 0, 0}},
                                                  {{1, 1, 2.5}, {0, 0, -1}},
                                                  {{0.1, 1.9, 2.5}, {0, 0, -1}}};
    std::vector<MeasuringPoint> points;
    for (const auto& [p, normal] : places) points.push_back({p, V3f(normal)});
    const auto found = measured(scene, points, 20'000, 4096);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& [p, normal] = places[i];
        check("reflection", "floor of rho = 0.8 in the sun",
              normal.z < 0 ? fmt::format("E of the ceiling at ({:g}, {:g}) m [lx]", p.x, p.y)
                           : fmt::format("E of the wall at ({:g}, {:g}) m [lx]", p.y, p.z),
              FloorLitByFace::illuminance(p, normal, 0, 2), found[i], 1e-3);
    }
    check("reflection", "floor of rho = 0.8 in the sun", "mean E of the wall, as solved [lx]",
          FloorLitByFace::radiosity * form_factor(FloorLitByFace::wall(), FloorLitByFace::floor()), solved(scene, 1, 1),
          1e-3);
    check("reflection", "floor of rho = 0.8 in the sun", "mean E of the ceiling, as solved [lx]",
          FloorLitByFace::radiosity * form_factor(FloorLitByFace::ceiling(), FloorLitByFace::floor()),
          solved(scene, 2, 1), 1e-3);
}

TEST(Reflection, IsHiddenByAScreen) {
    const std::vector<V3d> places{{0, 1, 0.2}, {0, 1, 1}, {0, 0.5, 2.2}};
    std::vector<MeasuringPoint> points;
    for (const V3d& p : places) points.push_back({p, {1, 0, 0}});
    const auto found = measured(FloorLitByFace::scene(true), points, 20'000, 4096);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const V3d& p = places[i];
        double expected = FloorLitByFace::illuminance(p, {1, 0, 0}, 0, 0.6);
        if (p.z > 0.5) expected += FloorLitByFace::illuminance(p, {1, 0, 0}, 0.6 * p.z / (p.z - 0.5), 2);
        check("reflection", "the same behind a screen", fmt::format("E of the wall at ({:g}, {:g}) m [lx]", p.y, p.z),
              expected, found[i], 1e-3);
    }
}

}  // namespace
}  // namespace interflect
