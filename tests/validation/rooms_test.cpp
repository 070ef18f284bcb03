// Interreflection in closed rooms, and the balance of power.
//
// Seen to fail when rho is 1% too small, 0.5% of the power is lost, the escaped power is that of the last pass, light
// transmitted by glass counts as absorbed.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "interflect/load.h"
#include "interflect/prepare.h"
#include "interflect/solution.h"
#include "tests/support/parameter_names.h"
#include "tests/support/scenes/scenes.h"
#include "tests/validation/cases/placement.h"

namespace interflect {
namespace {

using namespace testing_support;

using std::numbers::pi;
/// Upper limit of the share of its initial light that a pass leaves unshot.
constexpr double unshot = 1e-3;

class ClosedRoom : public testing::TestWithParam<double> {};  // rho
INSTANTIATE_TEST_SUITE_P(Rho, ClosedRoom, testing::Values(0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95),
                         printed_name);

/// All surfaces emit M and reflect rho: E = M / (1 - rho) everywhere.
TEST_P(ClosedRoom, ThatShinesAllAround) {
    const double rho = GetParam();
    const Scene scene = closed_box({2, 3, 2.5f}, 1, {{"", Rgb(static_cast<float>(rho)), Rgb(100)}});
    const std::string name = "all surfaces emit 100 lm/m²";
    check("rooms", name, fmt::format("rho = {:g}: mean E of a wall, as solved [lx]", rho), 100 / (1 - rho),
          solved(scene, 1, 1, 40'000), unshot);
    const auto found = measured(scene, {{{0.3, 2, 0}, {0, 0, 1}}}, 40'000, 1024);
    check("rooms", name, fmt::format("rho = {:g}: E of the floor at (0.3, 2) m [lx]", rho), 100 / (1 - rho), found[0],
          unshot);
}

/// A cube of 4 m with a lamp of 10 klm in its middle. The mean reflected illuminance on S = 96 m^2 is E = rho / (1 -
/// rho) Phi / S.
TEST_P(ClosedRoom, WithALamp) {
    constexpr double lumens = 10'000, surface = 96;
    const double rho = GetParam(), expected = rho / (1 - rho) * lumens / surface;
    Scene scene = closed_box({4, 4, 4}, 1, {{"", Rgb(static_cast<float>(rho)), Rgb(0)}});
    scene.luminaires = {{"lamp", 0, PointLight{{2, 2, 2}, Rgb(static_cast<float>(lumens / (4 * pi)))}}};
    const Estimate all = solved(scene, 0, 6, 20'000);
    check("rooms", "10 klm in a cube of 4 m", fmt::format("rho = {:g}: mean indirect E [lx]", rho), expected,
          {all.mean - lumens / surface, all.standard_error}, 2 * unshot);
}

/// The same with a two-sided table of the walls' reflectance: S is larger by both of its sides.
TEST(ClosedRoom, WithAnObstacle) {
    constexpr double lumens = 10'000, surface = 96 + 2 * 3, rho = 0.7;
    Scene scene = closed_box({4, 4, 4}, 1, {{"", Rgb(static_cast<float>(rho)), Rgb(0)}});
    add_rectangle(scene, {0.5f, 0.5f, 0.8f}, {1.5f, 0, 0}, {0, 2, 0}, 0, 1, 1, true);
    scene.luminaires = {{"lamp", 0, PointLight{{2, 2, 2}, Rgb(static_cast<float>(lumens / (4 * pi)))}}};
    check("rooms", "the same with a table of 1.5 m × 2 m", "rho = 0.7: mean E, as solved [lx]",
          lumens / surface / (1 - rho), solved(scene, 0, 8, 40'000), unshot);
}

// ---- Balance of power

void check_balance(const std::string& name, const Scene& scene, const SolveOptions& options) {
    const PowerBalance balance = power_balance(scene, solve(scene, RayCaster(scene), options));
    const double escaped = luminance(balance.escaped) / luminance(balance.emitted);
    check("balance", fmt::format("{}, {:.1f}% escapes", name, 100 * escaped), "absorbed + escaped [lm]",
          luminance(balance.emitted), {luminance(balance.absorbed + balance.escaped), 0}, 1e-3);
}

SolveOptions options_of(std::int64_t rays) { return {.method = find_method("hsrr"), .limits = {.rays = rays}}; }

Scene grey_room(float rho) {
    Scene scene = closed_box({4, 3, 2.5f}, 3, {{"", {rho, 0.8f * rho, 0.5f * rho}, Rgb(0)}});
    scene.patches[5 * 9 + 4].material = add_material(scene, Rgb(0.5f), {1000, 900, 700});
    return scene;
}

TEST(Balance, OfClosedRooms) {
    check_balance("room with a panel, rho = 0.5", grey_room(0.5f), options_of(200'000));
    check_balance("room with a panel, rho = 0.9", grey_room(0.9f), options_of(200'000));
    Scene pendant = grey_room(0.7f);
    Warnings warnings;
    const auto web =
        std::make_shared<PhotometricWeb>(load_photometric_web(repository() / "scenes/pendant.ies", {}, warnings));
    pendant.luminaires = {{"pendant", 0, MeasuredLight{web, {2, 1.5f, 1.8f}}}};
    check_balance("the same with pendant.ies, rho = 0.7", pendant, options_of(200'000));
}

TEST(Balance, OfOpenScenes) {
    Scene open = grey_room(0.7f);
    open.patches.erase(open.patches.begin() + 13);
    check_balance("room without a part of a wall", open, options_of(60'000));
    open.patches.erase(open.patches.begin(), open.patches.begin() + 8);
    check_balance("room without a wall", open, options_of(60'000));

    Scene window = grey_room(0.7f);
    window.materials.push_back({"glass", Rgb(0.1f), Rgb(0)});
    window.materials.back().transmittance = {0.8f, 0.85f, 0.8f};
    window.patches[13].material = 2;
    window.luminaires = {{"sky", 0, SkyDome{cie_standard_sky(12), Rgb(10'000), {0, 0, 1}, {1, 0.2f, 0.7f}, 0.2f}},
                         {"sun", 0, DirectionalLight{{-1, -0.2f, -0.7f}, Rgb(40'000), sun_diameter}}};
    check_balance("room with a pane of glass, a clear sky and the sun", window, options_of(400'000));
}

TEST(Balance, OfTheOffice) {
    const Scene scene = cut_at_contacts(load_scene(repository() / "scenes/office.mgf"));
    check_balance("scenes/office.mgf", scene, options_of(1'000'000));
    SolveOptions with_view{
        .method = find_method("ihsrr"), .views = {{scene.views.at(0)}}, .limits = {.rays = 3'000'000}};
    check_balance("scenes/office.mgf with a view", scene, with_view);
}

}  // namespace
}  // namespace interflect
