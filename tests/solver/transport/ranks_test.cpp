// Processes that share the rays of a run: their results have the bits of one process.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"
#include "interflect/solver.h"
#include "tests/support/release_only.h"
#include "tests/support/scenes/scenes.h"
#include "tests/support/thread_ranks.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

struct Setting {
    const char* name;
    std::function<void(SolveOptions&)> set;
    bool has_groups = false;
    friend void PrintTo(const Setting& s, std::ostream* out) { *out << s.name; }
};

class SharedRun : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(Settings, SharedRun,
                         testing::Values(Setting{"importance",
                                                 [](SolveOptions& o) { o.method = find_method("ihsrr"); }},
                                         Setting{"no_importance",
                                                 [](SolveOptions& o) {
                                                     o.method = find_method("hsrr");
                                                     o.views.clear();
                                                 }},
                                         Setting{"fixed_mesh", [](SolveOptions& o) { o.method = find_method("isrr"); }},
                                         Setting{"equal_power",
                                                 [](SolveOptions& o) {
                                                     o.method = find_method("hwdrs");
                                                     o.views.clear();
                                                 }},
                                         Setting{"as_published",
                                                 [](SolveOptions& o) {
                                                     use_published_algorithm(o);
                                                     o.experimental.warm_up = 1;
                                                     o.experimental.iterations = 4;
                                                     o.experimental.rays_per_iteration = 6'000;
                                                 }},
                                         Setting{"light_groups", [](SolveOptions& o) { o.keep_direct = true; }, true}),
                         [](const auto& setting) { return std::string(setting.param.name); });

/// With a table, an area lamp and a point light.
Scene room() {
    Scene scene = closed_box({4, 3, 2.5f}, 2, {{"wall", Rgb(0.6f, 0.4f, 0.5f), Rgb(0)}});
    scene.materials.push_back({"lamp", Rgb(0), Rgb(40)});
    add_rectangle(scene, {1, 1, 0.7f}, {1.5f, 0, 0}, {0, 1, 0}, 0, 3, 3, true);
    add_rectangle(scene, {2, 1, 2.4f}, {0, 0.5f, 0}, {0.5f, 0, 0}, 1, 1, 1, false);
    scene.luminaires = {{"", 0, PointLight{{0.3f, 0.4f, 2.1f}, {20, 30, 20}}}};
    return scene;
}

// Ranks share batches of 1,024 rays, so an iteration needs at least three batches.
TEST_P(SharedRun, HasTheBitsOfOneProcess) {
    Scene scene = room();
    if (GetParam().has_groups) scene.light_groups = {{"lamps", "lamp"}};
    const RayCaster ray_caster(scene);
    SolveOptions options{.method = find_method("ihsrr")};
    options.limits.rays = 30'000;
    options.views = {{View{"", {1, 1, 1}, {3, 2, 0.5}}}};
    GetParam().set(options);
    const Solution alone = solve(scene, ray_caster, options);
    EXPECT_GT(alone.iterations.size(), 1u);
    for (int count = is_sanitized ? 3 : 2; count <= 3; ++count)
        ThreadRanks(count).run([&](Ranks& ranks) {
            const Solution shared = solve(scene, ray_caster, options, {.on_progress = {}, .ranks = &ranks});
            EXPECT_EQ(shared.forest->subdivided(), alone.forest->subdivided());
            EXPECT_EQ(shared.irradiance, alone.irradiance);
            EXPECT_EQ(shared.groups, alone.groups);
            EXPECT_EQ(shared.direct, alone.direct);
            EXPECT_EQ(shared.indirect_importance, alone.indirect_importance);
            EXPECT_EQ(shared.iterations.size(), alone.iterations.size());
        });
}

}  // namespace
}  // namespace interflect
