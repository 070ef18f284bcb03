// Sizes of iterations, and which iterations are averaged (Eq. 6, Prikryl et al. 2000). Seen to fail if the rays of the
// warm-up or of importance count as averaged, if no short iteration precedes a long one, or if one does although the
// number of iterations is given.

#include "interflect/solver/state/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace interflect {

using namespace detail;
namespace {

constexpr std::size_t patches = 100;

std::vector<IterationPlan> all_plans(Schedule& schedule) {
    std::vector<IterationPlan> plans;
    for (IterationPlan plan = schedule.next(0); plan.rays > 0; plan = schedule.next(0)) {
        plans.push_back(plan);
        schedule.done({plan});
    }
    return plans;
}

TEST(Schedule, AveragesWhatComesAfterTheWarmUp) {
    SolveOptions options{.method = find_method("srr")};
    options.experimental.warm_up = 2;
    options.experimental.iterations = 4;
    options.experimental.rays_per_iteration = 1000;
    Schedule schedule(options, patches);
    const std::vector<IterationPlan> plans = all_plans(schedule);
    ASSERT_EQ(plans.size(), 6u);
    for (std::size_t k = 0; k < plans.size(); ++k) {
        EXPECT_EQ(plans[k].rays, 1000);
        EXPECT_EQ(plans[k].warms_up, k < 2) << k;
    }
    EXPECT_EQ(schedule.averaged_rays(), 4000) << "the warm-up is not averaged";
}

TEST(Schedule, CountsImportanceRaysOfTheStartButDoesNotAverageThem) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 10'000'000;
    Schedule schedule(options, patches);
    schedule.record_start(123'456, 44'000);
    EXPECT_EQ(schedule.rays(), 167'456);
    EXPECT_EQ(schedule.averaged_rays(), 123'456);
    const std::vector<IterationPlan> plans = all_plans(schedule);
    EXPECT_TRUE(std::none_of(plans.begin(), plans.end(), [](const IterationPlan& plan) { return plan.warms_up; }));
    EXPECT_EQ(schedule.rays(), 10'000'000);
    EXPECT_EQ(schedule.averaged_rays(), 10'000'000 - 44'000);
}

TEST(Schedule, SpendsTheBudgetExactly) {
    for (const std::int64_t rays : {1, 2, 999, 50'001, 1'234'567})
        for (const std::int64_t per_iteration : {0, 1, 1000})
            for (const int warm_up : {0, 3}) {
                SolveOptions options{.method = find_method("srr")};
                options.limits.rays = rays;
                options.experimental.rays_per_iteration = per_iteration;
                options.experimental.warm_up = warm_up;
                if (per_iteration == 1 && rays > 1000) continue;  // too many iterations
                Schedule schedule(options, patches);
                all_plans(schedule);
                EXPECT_EQ(schedule.rays(), rays) << per_iteration << ' ' << warm_up;
            }
}

TEST(Schedule, GrowsWithWhatIsAveraged) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 100'000'000;
    Schedule schedule(options, patches);
    schedule.record_start(100'000, 0);
    std::int64_t averaged = 100'000;
    const std::vector<IterationPlan> plans = all_plans(schedule);
    for (std::size_t k = 0; k + 1 < plans.size(); ++k) {  // the last one uses the remaining rays
        EXPECT_EQ(plans[k].rays, std::min<std::int64_t>(averaged / 2, 1 << 24)) << k;
        averaged += plans[k].rays;
    }
    EXPECT_LT(plans.size(), 30u);
}

TEST(Schedule, HasNoTinyLastIteration) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 10'300;
    options.experimental.rays_per_iteration = 1000;
    Schedule schedule(options, patches);
    EXPECT_EQ(all_plans(schedule).back().rays, 1300);
}

TEST(Schedule, EndsWithTheFinalIterationEvenIfLightRanOutBeforeTheRaysDid) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = 1000;
    Schedule schedule(options, patches);
    IterationPlan plan = schedule.next(0);
    for (; !plan.is_final; plan = schedule.next(0)) {
        ASSERT_GT(plan.rays, 0);
        schedule.done({plan});
    }
    schedule.done({.plan = plan, .rays = plan.rays - 2});
    EXPECT_EQ(schedule.rays(), 998);
    EXPECT_EQ(schedule.next(0).rays, 0);
}

TEST(Schedule, StartsWithFewRaysButSomeForEveryPatch) {
    SolveOptions options{.method = find_method("srr")};
    EXPECT_EQ(Schedule(options, patches).start_rays(), 50'000);
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 400'000);
    options.limits.rays = 80'000;
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 10'000) << "an eighth of the budget";
    EXPECT_EQ(Schedule(options, 100'000).start_rays(3), 3'333) << "an eighth in all";
    EXPECT_EQ(Schedule(options, 100).start_rays(2), 5'000);
    options.experimental.rays_per_iteration = 77;
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 77);
    options.experimental.rays_per_iteration = 1'000'000;
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 10'000) << "whatever an iteration has";
}

TEST(Schedule, FitsTheNextIterationIntoTheTimeThatIsLeft) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = std::numeric_limits<std::int64_t>::max();
    options.limits.time = 10;
    Schedule schedule(options, patches);
    schedule.record_start(1'000'000, 0);
    IterationPlan plan = schedule.next(1);
    EXPECT_EQ(plan.rays, 500'000) << "there is time enough";
    schedule.done({plan});
    plan = schedule.next(9);
    EXPECT_EQ(plan.rays, 53'125) << "half a million took eight seconds, one is left, and a margin is kept";
    schedule.done({plan});
    EXPECT_EQ(schedule.next(9.9).rays, 0) << "what fits into the rest is not worth an iteration";
    EXPECT_EQ(schedule.next(10).rays, 0);
    EXPECT_EQ(schedule.next(11).rays, 0);
}

TEST(Schedule, HasAShortIterationBeforeLongOnesUnlessTheirNumberIsAskedFor) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = options.experimental.rays_per_iteration = max_rays_per_iteration;
    Schedule schedule(options, patches);
    const std::vector<IterationPlan> plans = all_plans(schedule);
    ASSERT_EQ(plans.size(), 2u);
    EXPECT_EQ(plans[0].rays, 50'000);
    EXPECT_EQ(schedule.rays(), max_rays_per_iteration);
    options.experimental.iterations = 1;
    Schedule counted(options, patches);
    EXPECT_EQ(counted.next(0).rays, max_rays_per_iteration);
}

TEST(Schedule, FindsOutHowFastItIsBeforeALongIterationUnderALimitOfTime) {
    SolveOptions options{.method = find_method("srr")};
    options.limits.rays = options.experimental.rays_per_iteration = max_rays_per_iteration;
    options.limits.time = 10;
    Schedule schedule(options, patches);
    EXPECT_EQ(schedule.start_rays(), 1 << 18);
    IterationPlan plan = schedule.next(1);
    EXPECT_EQ(plan.rays, 50'000);
    schedule.done({plan});
    plan = schedule.next(2);
    EXPECT_EQ(plan.rays, 340'000) << "50,000 a second, 8 seconds, 0.85 of them";
}

}  // namespace
}  // namespace interflect
