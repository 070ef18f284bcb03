// Plans from the settings that a user gives: defaults that depend on others, and the preset of the paper.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "interflect/solve_options.h"

namespace interflect {
namespace {

constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();

GivenSettings published() {
    GivenSettings given;
    use_published_algorithm(given.others);
    given.is_published = true;
    return given;
}

TEST(GivenSettings, WithoutAnyAreTheDefaults) {
    const SolveOptions options = resolved({});
    EXPECT_EQ(options.method.name, std::string("hsrr"));
    EXPECT_EQ(options.limits.rays, 20'000'000);
    EXPECT_EQ(options.limits.time, std::numeric_limits<double>::infinity());
    EXPECT_EQ(options.experimental.rays_per_iteration, 0);
    EXPECT_FALSE(options.experimental.one_bounce);
}

TEST(GivenSettings, ChooseTheMethodByTheViews) {
    GivenSettings given;
    given.others.views.push_back({});
    EXPECT_EQ(resolved(given).method.name, std::string("ihsrr"));
    EXPECT_EQ(resolved(given).method.importance, find_method("ihsrr").importance);
    given.method = find_method("isrr");
    given.importance = ImportanceUse::direct;
    EXPECT_EQ(resolved(given).method.name, std::string("isrr"));
    EXPECT_EQ(resolved(given).method.importance, ImportanceUse::direct);
    EXPECT_EQ(resolved(given).views.size(), 1u);
}

TEST(GivenSettings, AGivenLimitReplacesTheDefaultLimit) {
    const Limits timed = resolved({.limits = {.time = 3}}).limits;
    EXPECT_EQ(timed.rays, unlimited);
    EXPECT_EQ(timed.time, 3);
    const Limits both = resolved({.limits = {.rays = 5, .until = 0.02}}).limits;
    EXPECT_EQ(both.rays, 5);
    EXPECT_EQ(both.until, 0.02);
}

/// 10 iterations warm up and 100 are averaged.
TEST(GivenSettings, DivideTheRaysOfThePaper) {
    GivenSettings given = published();
    EXPECT_EQ(resolved(given).experimental.rays_per_iteration, 20'000'000 / 110);
    EXPECT_TRUE(resolved(given).experimental.one_bounce);
    given.limits.rays = 1'100'000;
    EXPECT_EQ(resolved(given).experimental.rays_per_iteration, 10'000);
    given.limits = {.time = 1};
    EXPECT_EQ(resolved(given).experimental.rays_per_iteration, 0) << "they grow without a limit of rays";
}

TEST(GivenSettings, ReplaceThoseOfThePaper) {
    GivenSettings given = published();
    given.others.experimental.warm_up = 1;
    given.rays_per_iteration = 7;
    EXPECT_EQ(resolved(given).experimental.warm_up, 1);
    EXPECT_EQ(resolved(given).experimental.rays_per_iteration, 7);
    given.rays_per_iteration = 0;
    EXPECT_EQ(resolved(given).experimental.rays_per_iteration, 0);
}

}  // namespace
}  // namespace interflect
