// Daylight through openings: sky component and light from the ground, with and without glass. The rooms are black, so
// no light is reflected inside.
//
// Seen to fail when glass does not filter shadow rays, the ground is black, an overcast sky is 1 + 1.8 sin of the
// elevation, a sky is not scaled to its illuminance.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "interflect/scene/faces/patch_area.h"
#include "interflect/solve.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/scenes/skies.h"
#include "tests/validation/cases/closed_forms.h"
#include "tests/validation/cases/placement.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

using std::numbers::pi;
constexpr double outside = 10'000;  // horizontal illuminance of the sky [lx]
constexpr float transmittance = 0.7f, ground_reflectance = 0.3f;
const V3d sun(-1, 0.3, 0.8);  // beside the window; only scattered light of the sky

/// A sky and its luminance by independent formulas.
struct TestSky {
    std::string name;
    Luminaire luminaire;
    SkyLuminance luminance;
};

SkyDome dome(int type, float ground) {
    return {cie_standard_sky(type), Rgb(static_cast<float>(outside)), {0, 0, 1}, V3f(sun), ground};
}

std::vector<TestSky> skies(float ground) {
    const double below = static_cast<double>(ground) * outside / pi;
    return {{"uniform", {"sky", 0, dome(5, ground)}, uniform_sky(outside, below)},
            {"CIE overcast", {"sky", 0, dome(16, ground)}, overcast_sky(outside, below)},
            {"CIE clear", {"sky", 0, dome(12, ground)}, clear_sky(outside, sun, below)}};
}

/// A room of 5 x 4 x 3 m with one opening; front faces look inwards and come first.
struct Room {
    Scene scene;
    std::uint32_t black = 0;

    Room() { black = add_material(scene, Rgb(0), Rgb(0)); }

    void add(const V3f& corner, const V3f& u, const V3f& v) { add_rectangle(scene, corner, u, v, black, 1, 1, true); }
    /// Adds the rectangle with a hole from a to b, shares of u and v.
    void add_with_hole(const V3f& corner, const V3f& u, const V3f& v, const V2f& a, const V2f& b) {
        add(corner, u, v * a.y);
        add(corner + v * b.y, u, v * (1 - b.y));
        add(corner + v * a.y, u * a.x, v * (b.y - a.y));
        add(corner + v * a.y + u * b.x, u * (1 - b.x), v * (b.y - a.y));
    }
    void add_glass(const Rectangle& opening) {
        const std::uint32_t glass = add_material(scene, Rgb(0), Rgb(0));
        scene.materials[glass].transmittance = Rgb(transmittance);
        add_rectangle(scene, V3f(opening.corner), V3f(opening.u), V3f(opening.v), glass, 1, 1, true);
    }
    /// Adds the floor, and all walls except x = 0.
    void add_rest() {
        add({0, 0, 0}, {5, 0, 0}, {0, 4, 0});
        add({0, 0, 0}, {0, 0, 3}, {5, 0, 0});
        add({0, 4, 0}, {5, 0, 0}, {0, 0, 3});
        add({5, 0, 0}, {0, 0, 3}, {0, 4, 0});
    }
};

const Rectangle roof_opening{{1.5, 1, 3}, {0, 2, 0}, {2, 0, 0}};
const Rectangle window{{0, 0.5, 0.75}, {0, 2, 0}, {0, 0, 1.5}};

Room room_with_roof_opening() {
    Room room;
    room.add_rest();
    room.add({0, 0, 0}, {0, 4, 0}, {0, 0, 3});
    room.add_with_hole({0, 0, 3}, {0, 4, 0}, {5, 0, 0}, {0.25f, 0.3f}, {0.75f, 0.7f});
    return room;
}

Room room_with_window() {
    Room room;
    room.add_rest();
    room.add({0, 0, 3}, {0, 4, 0}, {5, 0, 0});
    room.add_with_hole({0, 0, 0}, {0, 4, 0}, {0, 0, 3}, {0.125f, 0.25f}, {0.625f, 0.75f});
    return room;
}

struct Place {
    const char* name;
    V3d position, normal;
};

/// @param factor  Factor on all expected values, for glass.
void check_room(const std::string& name, Scene scene, const Rectangle& opening, const std::vector<TestSky>& tested,
                const std::vector<Place>& places, double factor, double bias_bound,
                const std::function<bool(const V3d& from, const V3d& place)>& is_visible = {}) {
    std::vector<MeasuringPoint> points;
    for (const Place& p : places) points.push_back({p.position, V3f(p.normal)});
    for (const auto& [sky, luminaire, luminance] : tested) {
        scene.luminaires = {luminaire};
        const auto found = traced(scene, points, 32'768);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto& [place, position, normal] = places[i];
            const auto sees = [&, from = position](const V3d& x) { return !is_visible || is_visible(from, x); };
            check("daylight", fmt::format("{}, {} sky", name, sky), fmt::format("E of the {} [lx]", place),
                  factor * through_opening(position, normal, opening, luminance, sees), found[i], bias_bound);
        }
    }
}

const std::vector<Place> under_roof{{"floor under the middle", {2.5, 2, 0}, {0, 0, 1}},
                                    {"floor at (0.5, 1) m", {0.5, 1, 0}, {0, 0, 1}},
                                    {"wall at (2, 1.5) m", {0, 2, 1.5}, {1, 0, 0}}};
const std::vector<Place> behind_window{{"floor at (1, 1.75) m", {1, 1.75, 0}, {0, 0, 1}},
                                       {"floor at (3, 1) m", {3, 1, 0}, {0, 0, 1}},
                                       {"ceiling at (1.5, 2) m, lit by the ground", {1.5, 2, 3}, {0, 0, -1}},
                                       {"side wall at (1.5, 1.5) m", {1.5, 4, 1.5}, {0, -1, 0}}};

constexpr double rule_error = 2e-4;  // of the midpoint rule, and of single precision

TEST(RoofOpening, LetsTheSkyIn) {
    check_room("roof opening of 2 m × 2 m", room_with_roof_opening().scene, roof_opening, skies(0), under_roof, 1,
               rule_error);
    Room glazed = room_with_roof_opening();
    glazed.add_glass(roof_opening);
    check_room("the same with glass, tau = 0.7", glazed.scene, roof_opening, {skies(0)[1]}, under_roof, transmittance,
               rule_error);
}

TEST(Window, LetsTheSkyAndTheGroundIn) {
    check_room("window of 2 m × 1.5 m, ground of rho = 0.3", room_with_window().scene, window,
               skies(ground_reflectance), behind_window, 1, rule_error);
    Room glazed = room_with_window();
    glazed.add_glass(window);
    check_room("the same with glass, tau = 0.7", glazed.scene, window, {skies(ground_reflectance)[1]}, behind_window,
               transmittance, rule_error);
}

/// A black ledge above the window, 1 m deep and 40 m long.
TEST(Window, IsShadedByALedge) {
    constexpr double height = 2.3;
    Room room = room_with_window();
    room.add({-1, -20, static_cast<float>(height)}, {1, 0, 0}, {0, 40, 0});
    const auto is_visible = [](const V3d& from, const V3d& x) {
        const double at_edge = x.z + (x.z - from.z) / from.x;  // height of the line through x at 1 m outside
        return at_edge < height;
    };
    check_room("the same under a ledge of 1 m", room.scene, window, {skies(ground_reflectance)[1]},
               {behind_window[0], behind_window[1]}, 1, 2e-3, is_visible);
}

/// Under a uniform sky the floor has pi L F, with F in closed form. The flux through the window is its outside
/// illuminance times its area.
TEST(Window, KeepsItsFlux) {
    for (const auto& [sky, luminaire, luminance] : skies(ground_reflectance)) {
        Room room = room_with_window();
        room.scene.luminaires = {luminaire};
        const RayCaster ray_caster(room.scene);
        const auto found = means_of_runs(2, [&](std::uint64_t seed) {
            const Solution solution = solve(room.scene, ray_caster,
                                            {.method = find_method("srr"), .limits = {.rays = 150'000}, .seed = seed});
            double flux = 0;
            for (PatchIndex i{0}; i < room.scene.patches.size(); i += 2)
                flux += static_cast<double>(solution.irradiance[i].x) * patch_area(room.scene, room.scene.patches[i]);
            return std::vector{flux, static_cast<double>(solution.irradiance[0].x)};
        });
        check("daylight", "window, as solved", fmt::format("flux through it, {} sky [lm]", sky),
              window.area() * irradiance_of(luminance, {-1, 0, 0}), found[0], 1e-3);
        if (sky == "uniform")
            check("daylight", "window, as solved", "mean E of the floor, uniform sky [lx]",
                  outside * form_factor({{0, 0, 0}, {5, 0, 0}, {0, 4, 0}}, window), found[1], 1e-3);
    }
}

}  // namespace
}  // namespace interflect
