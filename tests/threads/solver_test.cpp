// The solver gives the same bits for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/generate.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/rooms/reference_rooms.h"
#include "tests/support/rooms/variants.h"
#include "tests/support/scenes/scenes.h"
#include "tests/threads/on_threads.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

/// Everything that a run computes, in the order of its computation.
auto bits_of(const Solution& s) {
    std::vector<std::uint32_t> mesh;
    for (ElementIndex e{0}; e < s.forest->size(); ++e) mesh.insert(mesh.end(), {s.forest->patch(e), s.forest->path(e)});
    return std::tuple(mesh, s.irradiance, s.indirect_importance, s.view_importance, s.rays);
}

void expect_same_bits_of_solutions(const Scene& scene, SolveOptions options) {
    const RayCaster ray_caster(scene);
    const auto solved = [&] { return bits_of(solve(scene, ray_caster, options)); };
    expect_same_bits(solved);
    const auto expected = solved();
    options.seed = 2;
    if (options.method.is_stochastic) {
        EXPECT_FALSE(solved() == expected) << "another seed";
    }
}

SolveOptions of_method(const std::string& method, std::int64_t rays) {
    SolveOptions options{.method = find_method(method)};
    options.limits.rays = rays;
    return options;
}

class SameBits : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, SameBits, testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const Method& method : methods) names.push_back(method.name);
                             return names;
                         }()),
                         [](const auto& test) {
                             std::string name = test.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST_P(SameBits, WithoutViews) { expect_same_bits_of_solutions(furnished_room(), of_method(GetParam(), 40'000)); }

TEST_P(SameBits, WithView) {
    SolveOptions options = of_method(GetParam(), 40'000);
    options.views = {{into_the_corner}};
    options.experimental.warm_up = 1;
    expect_same_bits_of_solutions(furnished_room(), options);
}

struct Setting {
    std::string name;
    std::function<void(SolveOptions&)> change;
};
void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

class SameBitsOfIhsrr : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(
    Settings, SameBitsOfIhsrr,
    testing::Values(Setting{"random_points", [](SolveOptions& o) { o.experimental.points = PointSet::random; }},
                    Setting{"perceptual",
                            [](SolveOptions& o) { o.refinement.criterion = RefinementCriterion::perceptual; }},
                    Setting{"by_power", [](SolveOptions& o) { o.refinement.criterion = RefinementCriterion::power; }},
                    Setting{"full_mesh", [](SolveOptions& o) { o.refinement.max_elements = 300; }}),
    [](const auto& test) { return test.param.name; });

TEST_P(SameBitsOfIhsrr, WithSetting) {
    SolveOptions options = of_method("ihsrr", 60'000);
    options.views = {{into_the_corner}};
    GetParam().change(options);
    expect_same_bits_of_solutions(furnished_room(), options);
}

TEST(SameBitsOfLinks, BetweenClusters) {
    SolveOptions options = of_method("hr", 100'000);
    options.experimental.epsilon = 1e-3;
    expect_same_bits_of_solutions(make_boxes({.boxes = 12}), options);
}

TEST(Solver, ConstFunctionsMayBeCalledFromSeveralThreads) {
    const TemporaryFolder folder;
    Solver solver(furnished_room(), {.limits = {.rays = 100'000}});
    solver.advance({});
    const Solver& run = solver;
    std::vector<std::vector<Rgb>> seen(4);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < seen.size(); ++i)
        threads.emplace_back([&, i] {
            if (i % 2 == 0) run.save(folder.path() / (std::to_string(i) + ".h5"));
            seen[i] = run.solution().irradiance;
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::vector<Rgb>& irradiance : seen) EXPECT_EQ(irradiance, seen[0]);
    EXPECT_EQ(Solver::open(folder.path() / "0.h5").solution().irradiance, seen[0]);
}

}  // namespace
}  // namespace interflect
