// Sizes of iterations, which of them are averaged (Eq. 6, Prikryl et al. 2000), and the estimate of the error.
// Seen to fail when the rays of the warm-up or of importance count as averaged, and (scripts/plant-faults) when the
// estimate forgets the noise of the earlier mean.

#include "interflect/solver/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace interflect {
namespace {

constexpr std::size_t patches = 100;

std::vector<IterationPlan> all_plans(Schedule& schedule) {
    std::vector<IterationPlan> plans;
    for (IterationPlan plan = schedule.next(0); plan.rays > 0; plan = schedule.next(0)) {
        plans.push_back(plan);
        schedule.done(plan);
    }
    return plans;
}

TEST(Schedule, AveragesWhatComesAfterTheWarmUp) {
    SolveOptions options;
    options.warm_up = 2;
    options.iterations = 4;
    options.rays_per_iteration = 1000;
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
    SolveOptions options;
    options.rays = 10'000'000;
    Schedule schedule(options, patches);
    schedule.began_with(123'456, 44'000);
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
                SolveOptions options;
                options.rays = rays;
                options.rays_per_iteration = per_iteration;
                options.warm_up = warm_up;
                if (per_iteration == 1 && rays > 1000) continue;  // too many iterations
                Schedule schedule(options, patches);
                all_plans(schedule);
                EXPECT_EQ(schedule.rays(), rays) << per_iteration << ' ' << warm_up;
            }
}

TEST(Schedule, GrowsWithWhatIsAveraged) {
    SolveOptions options;
    options.rays = 100'000'000;
    Schedule schedule(options, patches);
    schedule.began_with(100'000, 0);
    std::int64_t averaged = 100'000;
    const std::vector<IterationPlan> plans = all_plans(schedule);
    for (std::size_t k = 0; k + 1 < plans.size(); ++k) {  // the last one spends what is left
        EXPECT_EQ(plans[k].rays, std::min<std::int64_t>(averaged / 2, 1 << 24)) << k;
        averaged += plans[k].rays;
    }
    EXPECT_LT(plans.size(), 30u);
}

TEST(Schedule, HasNoTinyLastIteration) {
    SolveOptions options;
    options.rays = 10'300;
    options.rays_per_iteration = 1000;
    Schedule schedule(options, patches);
    EXPECT_EQ(all_plans(schedule).back().rays, 1300);
}

TEST(Schedule, StartsWithFewRaysButSomeForEveryPatch) {
    SolveOptions options;
    EXPECT_EQ(Schedule(options, patches).start_rays(), 50'000);
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 400'000);
    options.rays = 80'000;
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 10'000) << "an eighth of the budget";
    options.rays_per_iteration = 77;
    EXPECT_EQ(Schedule(options, 100'000).start_rays(), 77);
}

TEST(Schedule, FitsTheNextIterationIntoTheTimeThatIsLeft) {
    SolveOptions options;
    options.rays = std::numeric_limits<std::int64_t>::max();
    options.seconds = 10;
    Schedule schedule(options, patches);
    schedule.began_with(1'000'000, 0);
    EXPECT_EQ(schedule.next(1).rays, 500'000) << "there is time enough";
    EXPECT_EQ(schedule.next(9).rays, 111'111) << "a million took nine seconds, one is left";
    EXPECT_EQ(schedule.next(10).rays, 0);
    EXPECT_EQ(schedule.next(11).rays, 0);
}

class ErrorEstimates : public testing::Test {
  protected:
    static constexpr std::size_t elements = 600;
    const std::vector<double> weights_ = alternating_weights();

    /// What `rays` rays would estimate: `value` with a standard deviation of `spread` / sqrt(rays) in each element.
    static std::vector<double> estimate(double value, double spread, std::int64_t rays, std::uint64_t seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> estimated(value, spread / std::sqrt(static_cast<double>(rays)));
        std::vector<double> values(elements);
        for (double& v : values) v = estimated(random);
        return values;
    }

    static ErrorEstimate::Sums sums(const std::vector<double>& weights, const std::vector<double>& mean,
                                    const std::vector<double>& fresh) {
        ErrorEstimate::Sums sums;
        for (std::size_t i = 0; i < weights.size(); ++i) sums.add(weights[i], mean[i], fresh[i]);
        return sums;
    }

  private:
    static std::vector<double> alternating_weights() {
        std::vector<double> weights(elements, 1.0);
        for (std::size_t i = 0; i < elements; i += 2) weights[i] = 3;
        return weights;
    }
};

TEST_F(ErrorEstimates, FindTheErrorOfTheMean) {
    constexpr double value = 5, spread = 100;
    constexpr std::int64_t mean_rays = 30'000, rays = 10'000;
    ErrorEstimate error;
    for (std::uint64_t seed = 0; seed < 10; ++seed)
        error.add(
            sums(weights_, estimate(value, spread, mean_rays, 2 * seed), estimate(value, spread, rays, 2 * seed + 1)),
            mean_rays, rays);
    const double expected = spread / std::sqrt(40'000.0) / value;
    EXPECT_NEAR(error.relative(40'000) / expected, 1, 0.05);  // 6,000 differences: 1% noise
}

TEST_F(ErrorEstimates, DoNotSeeWhatDoesNotCount) {
    std::vector<double> first_half(elements, 0.0);
    std::fill_n(first_half.begin(), elements / 2, 2.0);
    std::vector<double> mean(elements, 5.0), received = mean;
    mean[0] = 5.5;
    ErrorEstimate without, with;
    without.add(sums(first_half, mean, received), 1000, 1000);
    received.back() = mean.back() = 1e9;
    mean[elements / 2] = -1e9;
    with.add(sums(first_half, mean, received), 1000, 1000);
    EXPECT_GT(without.relative(2000), 0);
    EXPECT_EQ(with.relative(2000), without.relative(2000));
}

TEST_F(ErrorEstimates, AreInfiniteUntilThereAreTwoIterations) {
    EXPECT_TRUE(std::isinf(ErrorEstimate().relative(1000)));
}

TEST_F(ErrorEstimates, AreZeroInTheDark) {
    ErrorEstimate error;
    const std::vector<double> dark(elements, 0.0);
    error.add(sums(weights_, dark, dark), 1000, 1000);
    EXPECT_EQ(error.relative(2000), 0);
}

}  // namespace
}  // namespace interflect
