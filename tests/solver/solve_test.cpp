// Contract of solve() apart from correct numbers: limits, interruption, reproducibility, errors.

#include "interflect/solve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solver.h"
#include "interflect/solver/light/materials.h"
#include "interflect/summary.h"
#include "tests/support/parameter_names.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::HasSubstr;
using namespace std::chrono_literals;

Solution solve(const Scene& scene, const SolveOptions& options, const Monitor& monitor = {}) {
    return interflect::solve(scene, RayCaster(scene), options, monitor);
}

SolveOptions with_rays(std::int64_t rays) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = rays;
    return options;
}

std::string error_of(const Scene& scene, const SolveOptions& options) {
    try {
        solve(scene, options);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

bool all_finite(const std::vector<Rgb>& colours) {
    return std::all_of(colours.begin(), colours.end(), [](const Rgb& c) { return is_finite(c); });
}

class Reproducible : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(Points, Reproducible, testing::Values(PointSet::sobol, PointSet::random), printed_name);

TEST_P(Reproducible, AnotherSeedGivesOtherBits) {
    const Scene scene = furnished_room();
    SolveOptions options = with_rays(100'000);
    options.experimental.points = GetParam();
    const std::vector<Rgb> irradiance = solve(scene, options).irradiance;
    options.seed = 2;
    EXPECT_NE(solve(scene, options).irradiance, irradiance);
}

TEST(Solve, FillsTheMeshUpToItsLimit) {
    const Scene scene = furnished_room();
    SolveOptions options{.method = find_method("hsrr")};
    options.limits.rays = 60'000;
    options.refinement.max_elements = 3 * scene.patches.size();
    const Solution solution = solve(scene, options);
    EXPECT_LE(solution.forest->size(), options.refinement.max_elements);
    EXPECT_GT(solution.forest->size() + 4, options.refinement.max_elements);
}

// Seen to fail with one ray on the command line: the preparation of hierarchical methods traced more rays than allowed.
TEST(Solve, TracesExactlyAsManyRaysAsItMay) {
    const Scene scene = colourful_box();
    for (const char* method : {"srr", "hsrr", "ihsrr"})
        for (const std::int64_t rays : {1, 2, 3, 4, 7, 12'345})
            for (const bool one_bounce : {false, true})
                for (const std::int64_t per_iteration : {0, 500'000}) {
                    SolveOptions options = with_rays(rays);
                    options.method = find_method(method);
                    options.views = {{into_the_corner}};
                    options.importance.camera_rays = 1000;
                    options.experimental.one_bounce = one_bounce;
                    options.experimental.rays_per_iteration = per_iteration;
                    const Solution solution = solve(scene, options);
                    EXPECT_EQ(solution.iterations.back().rays, rays) << method << ' ' << one_bounce;
                    EXPECT_TRUE(all_finite(solution.irradiance)) << rays;
                    EXPECT_FALSE(solution.interrupted);
                }
}

TEST(Solve, ReportsEveryIterationInOrder) {
    std::vector<IterationReport> reports;
    const Solution solution =
        solve(colourful_box(), with_rays(200'000),
              {[&](const Progress& progress) { reports.push_back(*progress.iteration); }, nullptr});
    ASSERT_EQ(reports.size(), solution.iterations.size());
    ASSERT_GE(reports.size(), 3u);
    EXPECT_EQ(reports[0].iteration, 1) << "there was nothing to prepare";
    EXPECT_TRUE(std::isinf(reports[0].error_estimate));
    for (std::size_t k = 1; k < reports.size(); ++k) {
        EXPECT_EQ(reports[k].iteration, static_cast<int>(k + 1));
        EXPECT_GT(reports[k].rays, reports[k - 1].rays);
        EXPECT_GE(reports[k].seconds, reports[k - 1].seconds);
        EXPECT_TRUE(std::isfinite(reports[k].error_estimate));
    }
}

// An interrupted iteration is discarded completely: the result is that of a run that ends before it. Seen to fail if
// the elements made by a step are kept, or if no batch checks for the request.
TEST(Solve, IsAsBeforeTheIterationThatWasCutShort) {
    const Scene scene = furnished_room();
    for (const char* name : {"ihsrr", "hwdrs", "random-walk", "photon-mesh", "global-lines", "pr"})
        for (const bool one_bounce : {false, true}) {
            SolveOptions options = with_rays(std::numeric_limits<std::int64_t>::max());
            options.method = find_method(name);
            options.experimental.one_bounce = one_bounce;
            if (options.method.importance != ImportanceUse::off) options.views = {{into_the_corner}};
            options.experimental.rays_per_iteration = 100'000;
            std::atomic<bool> stop{false};
            std::jthread timer;
            const auto stop_soon = [&](const Progress& progress) {
                if (progress.iteration->iteration == 1)
                    timer = std::jthread([&] {
                        std::this_thread::sleep_for(30ms);
                        stop = true;
                    });
            };
            const Solution cut_short = solve(scene, options, {stop_soon, &stop});
            EXPECT_TRUE(cut_short.interrupted) << name;

            options.experimental.iterations = cut_short.iterations.back().iteration;
            const Solution expected = solve(scene, options);
            EXPECT_FALSE(expected.interrupted);
            EXPECT_EQ(cut_short.forest->size(), expected.forest->size()) << name << ' ' << one_bounce;
            EXPECT_EQ(cut_short.irradiance, expected.irradiance) << name << ' ' << one_bounce;
        }
}

// A run that is stopped while it prepares starts over. Seen to fail if random walks forget their seed.
TEST(Solver, RepeatsAPreparationThatWasCutShort) {
    const auto scene = std::make_shared<const Scene>(furnished_room());
    for (const char* name : {"ihsrr", "random-walk", "pr"}) {
        SolveOptions options = with_rays(50'000);
        options.method = find_method(name);
        options.views = {{into_the_corner}};
        const std::atomic<bool> stop{true};
        Solver solver(scene, options);
        solver.advance({}, {{}, &stop});
        solver.advance({});
        EXPECT_EQ(solver.solution().irradiance, solve(*scene, options).irradiance) << name;
    }
}

TEST(Solve, IsNotInterruptedByACallThatComesAfterTheLastRay) {
    const std::atomic<bool> stop{true};
    SolveOptions options = with_rays(1000);
    options.experimental.one_bounce = true;
    options.experimental.rays_per_iteration = 1000;
    std::atomic<bool> late{false};
    const Monitor monitor{[&](const Progress&) { late = true; }, &late};
    EXPECT_FALSE(solve(colourful_box(), options, monitor).interrupted);
    EXPECT_TRUE(solve(colourful_box(), options, {{}, &stop}).interrupted);
}

TEST(Solve, KeepsToTheTimeLimit) {
    SolveOptions options = with_rays(std::numeric_limits<std::int64_t>::max());
    options.limits.time = 0.6;
    const IterationReport last = solve(colourful_box(), options).iterations.back();
    EXPECT_GT(last.seconds, 0.2) << "an iteration that would end too late may be lost";
    EXPECT_LT(last.seconds, 1.2) << "a bounce later at most, on a busy machine";
}

TEST(Solve, StopsOnceTheErrorIsSmallEnough) {
    SolveOptions options = with_rays(20'000'000);
    options.limits.until = 0.02;
    const IterationReport last = solve(colourful_box(), options).iterations.back();
    EXPECT_LE(last.error_estimate, 0.02);
    EXPECT_GT(last.error_estimate, 0) << "infinite and zero are no estimates";
    EXPECT_LT(last.rays, options.limits.rays / 10);
}

TEST(Solve, DoesAsManyIterationsAsItIsTold) {
    SolveOptions options = with_rays(1'000'000);
    options.experimental.one_bounce = true;
    options.experimental.warm_up = 3;
    options.experimental.iterations = 5;
    options.experimental.rays_per_iteration = 1000;
    const Solution solution = solve(colourful_box(), options);
    ASSERT_EQ(solution.iterations.size(), 8u);
    EXPECT_EQ(solution.iterations.back().rays, 8000);
}

TEST(Solve, CountsThePowerThatIsThere) {
    const Scene scene = closed_box({1, 2, 3}, 2, {{"wall", Rgb(0.5f), Rgb(1, 2, 3)}});
    const Solution solution = solve(scene, with_rays(50'000));
    constexpr double surface = 22;  // m^2
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(solution.emitted_power[channel], surface * (channel + 1), 1e-4);
        const double limit = surface * (channel + 1) / 0.5;
        EXPECT_NEAR(solution.iterations.back().total_power[channel] / limit, 1, 1.1e-3) << "0.1% may stay unshot";
    }
}

TEST(Solve, LeavesADarkSceneDark) {
    const Scene scene = closed_box({1, 1, 1}, 2, {{"wall", Rgb(0.5f), Rgb(0)}});
    const Solution solution = solve(scene, with_rays(1000));
    EXPECT_EQ(solution.irradiance, std::vector<Rgb>(scene.patches.size(), Rgb(0)));
    EXPECT_TRUE(solution.iterations.empty());
    EXPECT_FALSE(solution.interrupted);
}

TEST(Solve, CarriesEnormousAndTinyLights) {
    for (const float exitance : {1e-9f, 1e10f}) {
        const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(exitance)}});
        const Solution solution = solve(scene, with_rays(10'000));
        EXPECT_EQ(solution.non_finite, 0);
        for (const Rgb& h : solution.irradiance) EXPECT_NEAR(h.x / exitance, 2, 0.2);
    }
}

TEST(Solve, RefusesLightsBeyondSinglePrecision) {
    // Their variances exceed single precision; for the last, the sum of all bounces does too.
    for (const Rgb& exitance : {Rgb(1e-30f), Rgb(1e30f), Rgb(3e38f, 1, 1)}) {
        const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.9f), exitance}});
        EXPECT_THROW(solve(scene, with_rays(10'000)), InputError) << exitance;
    }
}

TEST(Solve, RefusesOrthographicViews) {
    const Scene scene = closed_box({1, 1, 1}, 1, {{"wall", Rgb(0.5f), Rgb(1)}});
    SolveOptions options = with_rays(10'000);
    View plan{"plan", V3f(0.5f, 0.5f, 0.9f), V3f(0.5f, 0.5f, 0), V3f(0, 1, 0)};
    options.views.push_back({plan});
    EXPECT_NO_THROW(solve(scene, options));
    options.views.front().view.extent = 1;
    EXPECT_THROW(solve(scene, options), InputError);
}

TEST(Solve, ListsAllOptionsOutOfRange) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 0;
    options.limits.time = std::nan("");
    options.limits.until = 1;
    options.experimental.warm_up = -1;
    options.experimental.iterations = -1;
    options.experimental.rays_per_iteration = -1;
    options.experimental.epsilon = 0;
    options.experimental.epsilon_decay = 2;
    options.refinement.min_area = -1;
    options.refinement.max_elements = 3;
    options.experimental.alpha = 1.5;
    options.experimental.beta = -0.1;
    options.experimental.inherited_weight = 2;
    options.importance.smoothing = options.importance.exponent = -0.5;
    options.importance.camera_rays = 0;
    const std::string message = error_of(colourful_box(), options);
    for (const char* name : {"rays:", "time:", "until:", "warm_up:", "iterations:", "rays_per_iteration:", "epsilon:",
                             "epsilon_decay:", "min_area:", "max_elements:", "alpha:", "beta:", "inherited_weight:",
                             "importance_smoothing:", "importance_exponent:", "camera_rays:"})
        EXPECT_THAT(message, HasSubstr(name));
}

TEST(Solve, RefusesABrokenScene) {
    Scene scene = colourful_box();
    scene.materials[0].exitance.x = std::nanf("");
    scene.materials[1].reflectance = Rgb(1.5f);
    const std::string message = error_of(scene, {});
    EXPECT_THAT(message, HasSubstr("material 'red': exitance"));
    EXPECT_THAT(message, HasSubstr("material 'green': reflectance"));
    Scene empty = colourful_box();
    empty.patches.clear();
    EXPECT_THAT(error_of(empty, {}), HasSubstr("no patches"));
}

TEST(Solve, RefusesTheRayCasterOfAnotherScene) {
    const Scene scene = colourful_box(), larger = closed_box({2, 2, 2}, 3, {{"wall", Rgb(0.5f), Rgb(1)}});
    const RayCaster ray_caster(larger);
    SolveOptions options = with_rays(1000);
    for (const Method& method : methods) {
        options.method = method;
        EXPECT_THROW(interflect::solve(scene, ray_caster, options), InputError) << method.name;
    }
    EXPECT_THROW(interflect::covered_emission(scene, ray_caster), InputError);
}

TEST(Solve, RefusesViewsThatCannotBeLookedAtTogether) {
    const View view{"inside", V3f(0.5f), V3f(0.9f, 0.6f, 0.5f)};
    for (const WeightedView& broken :
         {WeightedView{view, -1}, WeightedView{view, 1, std::nanf("")}, WeightedView{view, 1, 1, 0}}) {
        SolveOptions options = with_rays(1000);
        options.views = {broken};
        EXPECT_THAT(error_of(colourful_box(), options), HasSubstr("view 'inside': weight, aspect and pixel_rows"));
    }
}

TEST(Solve, NamesTheLeastNumberOfElements) {
    SolveOptions options = with_rays(1000);
    options.refinement.max_elements = 1;
    const Scene scene = colourful_box();
    EXPECT_THAT(error_of(scene, options), HasSubstr("max_elements: 1, expected at least the number of patches, " +
                                                    std::to_string(scene.patches.size())));
}

}  // namespace
}  // namespace interflect
