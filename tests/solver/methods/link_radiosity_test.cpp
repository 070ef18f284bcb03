// Hierarchical radiosity over links has no noise, so its results are compared directly with closed forms and dense
// solutions. The tolerances are a small multiple of the error of the quadrature, the mesh and the lines of sight.
//
// Seen to fail if importance lacks rho, a line of sight is traced from one end only or never, power is not divided by
// the area, a link transports light in one direction only, polygons are not clipped at the horizon, form factors are
// taken from the larger element or lack 0.5%, triangles have the weights of squares, push or pull is omitted, or a
// divided link remains. Also if the error bound lacks psi or rho, is 0 for partly or wholly hidden links, or ignores
// the spread of the form factor; if rays, links or the smallest area are not limited; or if sweeps end before the light
// has converged.

#include "interflect/solver/methods/links/link_radiosity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <ostream>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/methods/links/exchange.h"
#include "tests/support/brute_force.h"
#include "tests/support/form_factors.h"
#include "tests/support/parameter_names.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

const Method without_importance = find_method("hr");
const Method with_importance = [] {
    Method method = find_method("hr");
    method.importance = ImportanceUse::full;
    return method;
}();

SolveOptions refined_to(double epsilon) {
    SolveOptions options{.method = without_importance};
    options.experimental.epsilon = epsilon;
    return options;
}

/// Returns options for one element per patch.
SolveOptions unrefined() {
    SolveOptions options = refined_to(1);
    options.method.refines = false;
    return options;
}

Solution solve_scene(const Scene& scene, const SolveOptions& options) {
    return solve(scene, RayCaster(scene), options);
}

// Form factors from a point to a polygon.

TEST(FormFactorToPolygon, OfASquareAboveItsCornerIsTheCataloguesFigure) {
    // Howell B-3 (a differential element below the corner of a parallel rectangle), with sides of 1 at distance 1.
    const double s = 1 / std::sqrt(2.0);
    const double expected = 2 * s * std::atan(s) / (2 * std::numbers::pi);
    const std::array<V3d, 4> square{{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};  // lit from below
    EXPECT_NEAR(form_factor_to_polygon({0, 0, 0}, {0, 0, 1}, square), expected, 1e-12);
}

TEST(FormFactorToPolygon, IsCutAtTheHorizon) {
    // A wall extends equally far above and below the ground; only the part above counts.
    const std::array<V3d, 4> whole{{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}};
    const std::array<V3d, 4> above{{{1, -1, 0}, {1, 1, 0}, {1, 1, 1}, {1, -1, 1}}};
    const std::array<V3d, 4> turned{{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}};
    const V3d x(0, 0, 0), up(0, 0, 1);
    EXPECT_GT(form_factor_to_polygon(x, up, turned), 0.05);
    EXPECT_EQ(form_factor_to_polygon(x, up, whole), 0) << "from behind";
    const std::array<V3d, 4> above_turned{{above[0], above[3], above[2], above[1]}};
    EXPECT_NEAR(form_factor_to_polygon(x, up, turned), form_factor_to_polygon(x, up, above_turned), 1e-12);
}

// Two squares.

struct Squares {
    const char* name;
    Rectangle from, to;
    double quadrature_error;
};

std::ostream& operator<<(std::ostream& out, const Squares& squares) { return out << squares.name; }

class UnitSquares : public testing::TestWithParam<Squares> {};
INSTANTIATE_TEST_SUITE_P(
    All, UnitSquares,
    testing::Values(
        Squares{"parallel", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, 2e-6},
        Squares{"perpendicular", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1e-3},
        Squares{"near", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0.4, 0.4, 0.05}, {0, 0.2, 0}, {0.2, 0, 0}}, 1e-5}),
    [](const auto& test) { return test.param.name; });

/// Returns two squares: `from` emits one lumen and reflects nothing; `to` is patch 1.
Scene lit_squares(const Squares& squares) {
    Scene scene;
    add_material(scene, Rgb(0), Rgb(static_cast<float>(1 / squares.from.area())));
    add_material(scene, Rgb(0), Rgb(0));
    std::uint32_t material = 0;
    for (const Rectangle& r : {squares.from, squares.to})
        add_rectangle(scene, V3f(r.corner), V3f(r.u), V3f(r.v), material++);
    return scene;
}

TEST_P(UnitSquares, ExchangeTheClosedFormsShare) {
    const Solution s = solve_scene(lit_squares(GetParam()), unrefined());
    const double share = s.irradiance[1].x * s.forest->area(ElementIndex(1));
    EXPECT_NEAR(share, form_factor(GetParam().from, GetParam().to), GetParam().quadrature_error);
}

/// Returns the mean irradiance of each patch, given a finer mesh of n x n elements per patch.
std::vector<RgbD> means_of(const std::vector<RgbD>& finer, std::size_t n) {
    std::vector<RgbD> means(finer.size() / (n * n), RgbD(0, 0, 0));
    for (std::size_t i = 0; i < finer.size(); ++i) means[i / (n * n)] += finer[i] / static_cast<double>(n * n);
    return means;
}

double sum_over_leaves(const Solution& s, const std::vector<float>& per_area, const std::vector<Rgb>& weight) {
    double sum = 0;
    for (const ElementIndex e : s.forest->leaves())
        sum += static_cast<double>(per_area[e]) * s.forest->area(e) * channel_sum(weight[e]) / 3;
    return sum;
}

TEST(LinkRadiosity, TrianglesExchangeWhatTheirSquareDoes) {
    const Squares& squares = {"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, 0};
    Scene scene = lit_squares(squares);
    const auto v = scene.patches[1].vertices;
    scene.patches[1].vertices = {v[0], v[1], v[2], none};
    Patch other_half = scene.patches[1];
    other_half.vertices = {v[0], v[2], v[3], none};
    scene.patches.push_back(other_half);
    scene.materials[1].reflectance = Rgb(0.5f);  // a black patch would not be refined
    for (const SolveOptions& options : {unrefined(), refined_to(1e-3)}) {
        const Solution s = solve_scene(scene, options);
        const float share = 0.5f * (s.irradiance[1].x + s.irradiance[2].x);
        EXPECT_NEAR(share, form_factor(squares.from, squares.to), 1e-4);
    }
}

// On undivided patches the result is the dense solution, apart from quadrature and lines of sight.

class Furnace : public testing::TestWithParam<float> {};  // rho
INSTANTIATE_TEST_SUITE_P(Rho, Furnace, testing::Values(0.0f, 0.5f, 0.9f), printed_name);

TEST_P(Furnace, OfPatchesIsExactButForQuadrature) {
    const Scene scene = closed_box({1, 2, 3}, 3, {{"wall", Rgb(GetParam()), Rgb(2)}});
    const double expected = 2 / (1 - static_cast<double>(GetParam()));  // H = B = M / (1 - rho)
    for (const Rgb& h : solve_scene(scene, unrefined()).irradiance) EXPECT_NEAR(h.x / expected, 1, 1.5e-3);
}

TEST(LinkRadiosity, IsTheDenseSolutionOfAColourfulBox) {
    const Scene scene = colourful_box();
    const std::vector<RgbD> exact = dense_irradiance(scene, exact_form_factors(scene));
    EXPECT_LT(relative_error(scene, solve_scene(scene, unrefined()).irradiance, exact), 5e-4);
}

TEST(LinkRadiosity, IsTheDenseSolutionOfAFurnishedRoom) {
    const Scene scene = furnished_room();
    const std::vector<RgbD> reference = dense_irradiance(scene, traced_form_factors(scene, 10'000, 1));
    EXPECT_LT(relative_error(scene, solve_scene(scene, unrefined()).irradiance, reference), 0.025);
}

TEST(LinkRadiosity, CountsWhatEscapesFromAnOpenBox) {
    const Scene scene = open_colourful_box();
    const FormFactors f = exact_form_factors(scene);
    const Materials materials(scene);
    const std::vector<RgbD> exact = dense_irradiance(scene, f);
    RgbD escaping(0, 0, 0);
    for (std::uint32_t i = 0; i < exact.size(); ++i)
        escaping += (RgbD(materials.exitance(PatchIndex(i))) + RgbD(materials.reflectance(PatchIndex(i))) * exact[i]) *
                    (static_cast<double>(patch_area(scene, scene.patches[i])) * (1 - f.row_sum(i)));
    const RgbD escaped = solve_scene(scene, unrefined()).iterations.back().escaped_power;
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(escaped[channel] / escaping[channel], 1, 2e-3);
}

TEST(LinkRadiosity, OfASceneWithoutLightIsDark) {
    const Solution s = solve_scene(closed_box({1, 2, 3}, 1, {{"wall", Rgb(0.5f), Rgb(0)}}), refined_to(1e-3));
    for (const Rgb& h : s.irradiance) EXPECT_EQ(h, Rgb(0));
}

// Occlusion.

/// Returns a black lamp of 1 lm and a grey floor, patches 0 and 1, a metre apart. Material 2, for additions, is black.
Scene lamp_over_floor() {
    Scene scene = lit_squares({"", {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0});
    scene.materials[1].reflectance = Rgb(0.5f);
    add_material(scene, Rgb(0), Rgb(0));
    return scene;
}

TEST(LinkRadiosity, LightDoesNotPassASurfaceThatFacesIt) {
    Scene scene = lamp_over_floor();
    add_rectangle(scene, {-9, -9, 0.5f}, {19, 0, 0}, {0, 19, 0}, 2, 1, 1, true);
    EXPECT_EQ(solve_scene(scene, unrefined()).irradiance[1], Rgb(0));
}

TEST(LinkRadiosity, NothingIsExchangedThroughTheBackOfASurfaceThatStopsTheOtherWay) {
    for (const bool faces_lamp : {true, false}) {
        Scene scene = lamp_over_floor();
        const V3f u(19, 0, 0), v(0, 19, 0);
        add_rectangle(scene, {-9, -9, 0.5f}, faces_lamp ? u : v, faces_lamp ? v : u, 2);
        EXPECT_EQ(solve_scene(scene, unrefined()).irradiance[1], Rgb(0)) << faces_lamp;
    }
}

TEST(LinkRadiosity, OfCoincidentFacesOneIsLit) {
    Scene scene = lamp_over_floor();
    add_rectangle(scene, {0.25f, 0.25f, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}, 2);  // paper on the floor
    SolveOptions options = refined_to(1e-4);
    options.refinement.min_area = 0.01;
    const Solution s = solve_scene(scene, options);
    const ElementForest& forest = *s.forest;
    EXPECT_EQ(s.irradiance[forest.leaf_at(PatchIndex(1), {0.5f, 0.5f})], Rgb(0)) << "the floor below the paper";
    EXPECT_GT(s.irradiance[2].x, 0.2);
    EXPECT_GT(s.irradiance[forest.leaf_at(PatchIndex(1), {0.1f, 0.1f})].x, 0.1);
}

/// Returns the irradiance of the floor through a slit between x = low and x = high in a board at half height, unbounded
/// in y. A strip of the floor at x sees the lamp from 2 low - x to 2 high - x.
double expected_through_slit(double low, double high) {
    constexpr int strips = 256;
    double sum = 0;
    for (int i = 0; i < strips; ++i) {
        const double x = (i + 0.5) / strips;
        const double from = std::clamp(2 * low - x, 0.0, 1.0), to = std::clamp(2 * high - x, 0.0, 1.0);
        if (to <= from) continue;
        sum += form_factor({{static_cast<double>(i) / strips, 0, 0}, {1.0 / strips, 0, 0}, {0, 1, 0}},
                           {{from, 0, 1}, {0, 1, 0}, {to - from, 0, 0}});
    }
    return sum / strips;
}

void add_board(Scene& scene, float from, float to) {
    add_rectangle(scene, {from, -9, 0.5f}, {to - from, 0, 0}, {0, 19, 0}, 2, 1, 1, true);
}

TEST(LinkRadiosity, FindsTheShadowOfABoard) {
    Scene scene = lamp_over_floor();
    add_board(scene, -9, 0.5f);
    const Solution s = solve_scene(scene, refined_to(1e-3));
    EXPECT_NEAR(s.irradiance[1].x / expected_through_slit(0.5, 10), 1, 0.01);
    EXPECT_LT(s.irradiance[s.forest->leaf_at(PatchIndex(1), {0.01f, 0.5f})].x, 0.02);
}

TEST(LinkRadiosity, FindsLightThatTheFirstLinesMissed) {
    Scene scene = lamp_over_floor();
    add_board(scene, -9, 0.3f);
    add_board(scene, 0.301f, 10);
    EXPECT_EQ(solve_scene(scene, unrefined()).irradiance[1], Rgb(0));
    // Such a narrow slit is found when elements have almost their smallest size, 5 mm.
    EXPECT_NEAR(solve_scene(scene, refined_to(1e-6)).irradiance[1].x / expected_through_slit(0.3, 0.301), 1, 0.2);
}

TEST(LinkRadiosity, WhatReflectsNothingIsNotRefined) {
    Scene scene = lamp_over_floor();
    EXPECT_GT(solve_scene(scene, refined_to(1e-3)).forest->size(), 2u);
    scene.materials[1].reflectance = Rgb(0);
    EXPECT_EQ(solve_scene(scene, refined_to(1e-3)).forest->size(), 2u);
}

// Refinement.

TEST(LinkRadiosity, RefinedApproachesTheDenseSolutionOfAFineMesh) {
    const Scene scene = closed_box({1, 2, 3}, 1, colourful_box().materials);
    const Scene finer = closed_box({1, 2, 3}, 6, scene.materials);
    const std::vector<RgbD> exact = means_of(dense_irradiance(finer, exact_form_factors(finer)), 6);
    const auto error = [&](const SolveOptions& options) {
        const Solution s = solve_scene(scene, options);
        return relative_error(scene, s.irradiance, exact);
    };
    EXPECT_GT(error(unrefined()), 0.05);
    EXPECT_LT(error(refined_to(1e-3)), 0.02);
    EXPECT_LT(error(refined_to(1e-5)), 0.01);
}

TEST(LinkRadiosity, RefinesMoreAsEpsilonFallsAndOnlyWhereAsked) {
    const Scene scene = colourful_box();
    std::uint32_t last = solve_scene(scene, unrefined()).forest->size();
    EXPECT_EQ(last, scene.patches.size());
    for (const double epsilon : {1e-2, 1e-3, 1e-4}) {
        const std::uint32_t elements = solve_scene(scene, refined_to(epsilon)).forest->size();
        EXPECT_GT(elements, last);
        last = elements;
    }
}

TEST(LinkRadiosity, RefinementKeepsItsLimits) {
    const Scene scene = colourful_box();
    SolveOptions options = refined_to(1e-5);
    options.refinement.max_elements = 200;
    EXPECT_LE(solve_scene(scene, options).forest->size(), 200u);

    options = refined_to(1e-5);
    options.refinement.min_area = 0.02;
    const Solution coarse = solve_scene(scene, options);
    for (ElementIndex e{0}; e < coarse.forest->size(); ++e) ASSERT_GE(coarse.forest->area(e), 0.02f);

    options = refined_to(1e-5);
    const std::int64_t first_rays = solve_scene(scene, unrefined()).iterations.back().rays;
    options.limits.rays = 2 * first_rays;
    const std::int64_t rays = solve_scene(scene, options).iterations.back().rays;
    EXPECT_LE(rays, options.limits.rays);
    EXPECT_GT(rays, first_rays);
}

TEST(LinkRadiosity, ClosedBoxLosesNoPowerOnAnyMesh) {
    const Scene scene = closed_box({1, 2, 3}, 3, {{"wall", Rgb(0.5f), Rgb(2)}});
    for (const double epsilon : {1e-2, 1e-3, 1e-4}) {
        const Solution s = solve_scene(scene, refined_to(epsilon));
        const IterationReport& last = s.iterations.back();
        EXPECT_LT(std::abs(last.escaped_power.x), 0.01 * last.total_power.x) << "epsilon " << epsilon;
        EXPECT_NEAR(last.total_power.x, 22 * 4, 0.02 * 22 * 4) << "22 m^2 of B = M / (1 - rho)";
    }
}

void solve_with_links(const Scene& scene, const SolveOptions& options, std::size_t link_limit) {
    const RayCaster ray_caster(scene);
    SolverState state(scene, ray_caster, options);
    LinkedElements elements(state, link_limit);
    elements.prepare(state);
    for (IterationPlan plan = elements.plan(state); plan.rays > 0; plan = elements.plan(state)) {
        TracedIteration iteration{plan};
        elements.trace(state, iteration);
    }
}

TEST(LinkRadiosity, NamesARemedyWhereThereAreTooManyLinks) {
    const Scene scene = colourful_box();
    try {
        solve_with_links(scene, unrefined(), 1000);
        FAIL() << "expected an InputError";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("closed box"), testing::HasSubstr("1000 links"),
                                             testing::HasSubstr("epsilon")));
    }
    EXPECT_THROW(solve_with_links(scene, refined_to(1e-5), 2000), InputError);
}

TEST(LinkRadiosity, StopsWhenAskedAndAtItsLimits) {
    const Scene scene = colourful_box();
    SolveOptions options = refined_to(1e-3);
    options.experimental.iterations = 3;
    EXPECT_EQ(solve_scene(scene, options).iterations.size(), 3u);
    options.experimental.iterations = 0;
    options.limits.time = 1e-9;
    const Solution dark = solve_scene(scene, options);
    EXPECT_FALSE(dark.interrupted) << "a limit of time is no interruption";
    EXPECT_TRUE(dark.iterations.empty()) << "links were not even made";
    EXPECT_EQ(dark.irradiance, std::vector<Rgb>(dark.forest->size(), Rgb(0)));

    std::atomic<bool> stop{false};
    const Monitor monitor{[&](const Progress& progress) { stop = progress.iteration->iteration == 2; }, &stop};
    const Solution s = solve(scene, RayCaster(scene), refined_to(1e-3), monitor);
    EXPECT_TRUE(s.interrupted);
    EXPECT_EQ(s.iterations.size(), 2u);
    EXPECT_GT(s.irradiance[0].x, 0);
}

// Importance.

/// Returns two grey rooms with a doorway between them, each with a lamp. The camera stands in the first, facing away
/// from the door.
Scene two_rooms() {
    Scene scene;
    const std::uint32_t white = add_material(scene, Rgb(0.7f), Rgb(0)), lamp = add_material(scene, Rgb(0), Rgb(50));
    for (const float x : {0.0f, 4.0f}) {
        add_rectangle(scene, {x, 0, 0}, {4, 0, 0}, {0, 3, 0}, white);                 // floor
        add_rectangle(scene, {x, 0, 2.5f}, {0, 3, 0}, {4, 0, 0}, white);              // ceiling
        add_rectangle(scene, {x, 0, 0}, {0, 0, 2.5f}, {4, 0, 0}, white);              // y = 0
        add_rectangle(scene, {x, 3, 0}, {4, 0, 0}, {0, 0, 2.5f}, white);              // y = 3
        add_rectangle(scene, {x + 1.5f, 1, 2.4f}, {0, 1, 0}, {1, 0, 0}, lamp, 1, 1);  // faces down
    }
    add_rectangle(scene, {0, 0, 0}, {0, 3, 0}, {0, 0, 2.5f}, white);
    add_rectangle(scene, {8, 0, 0}, {0, 0, 2.5f}, {0, 3, 0}, white);
    add_rectangle(scene, {4, 0, 0}, {0, 2, 0}, {0, 0, 2.5f}, white, 1, 1, true);  // between the rooms; the door is from
                                                                                  // y = 2 to y = 3
    return scene;
}
constexpr std::uint32_t first_of_second_room = 5;

SolveOptions seen_from_the_first_room(const Method& method, double epsilon) {
    SolveOptions options = refined_to(epsilon);
    options.method = method;
    options.views = {{View{"first room", {3.5f, 1.5f, 1.2f}, {0, 1.4f, 1}, {0, 0, 1}, 60}}};
    return options;
}

std::uint32_t elements_of_patches(const Solution& s, std::uint32_t first, std::uint32_t end) {
    std::uint32_t count = 0;
    for (ElementIndex e{0}; e < s.forest->size(); ++e) count += s.forest->patch(e) >= first && s.forest->patch(e) < end;
    return count;
}

/// Returns sum v P, the measurement of the view.
double measured(const Scene& scene, const Solution& s) {
    return sum_over_leaves(s, s.view_importance, radiosity(Materials(scene), *s.forest, s.irradiance));
}

TEST(LinkRadiosityWithImportance, RefinesWhatIsSeenAndLeavesTheRest) {
    const Scene scene = two_rooms();
    const Solution all = solve_scene(scene, seen_from_the_first_room(without_importance, 1e-4));
    const Solution seen = solve_scene(scene, seen_from_the_first_room(with_importance, 1e-4));
    const auto in_first = [](const Solution& s) { return elements_of_patches(s, 0, first_of_second_room); };
    const auto in_second = [](const Solution& s) { return elements_of_patches(s, first_of_second_room, 10); };
    EXPECT_LT(in_second(seen), 0.5 * in_second(all));
    EXPECT_GT(in_first(seen), 0.5 * in_first(all));
    EXPECT_NEAR(measured(scene, seen) / measured(scene, all), 1, 0.02);
}

TEST(LinkRadiosityWithImportance, LightAndImportanceMeasureTheSameOnAnyMesh) {
    const Scene scene = two_rooms();
    for (const double epsilon : {1.0, 1e-2, 1e-3}) {
        const Solution s = solve_scene(scene, seen_from_the_first_room(with_importance, epsilon));
        std::vector<float> psi = s.view_importance;
        for (std::size_t e = 0; e < psi.size(); ++e) psi[e] += s.indirect_importance[e];
        const std::vector<Rgb> dark(s.forest->size(), Rgb(0));
        const double by_importance = sum_over_leaves(s, psi, radiosity(Materials(scene), *s.forest, dark));
        EXPECT_NEAR(by_importance / measured(scene, s), 1, 1e-4) << "epsilon " << epsilon;
    }
}

}  // namespace
}  // namespace interflect
