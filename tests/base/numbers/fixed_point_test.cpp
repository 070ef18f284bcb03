#include "interflect/base/numbers/fixed_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests/support/parameter_names.h"

namespace interflect {

using namespace detail;
namespace {

std::vector<RgbD> random_colours(std::size_t count) {
    std::mt19937_64 random(1);
    std::lognormal_distribution<double> magnitude(0, 4);  // spread over several powers of ten
    std::vector<RgbD> colours;
    for (std::size_t i = 0; i < count; ++i)
        colours.emplace_back(magnitude(random), magnitude(random), magnitude(random));
    return colours;
}

double sum_of_channels(const std::vector<RgbD>& colours) {
    double sum = 0;
    for (const RgbD& c : colours) sum += channel_sum(c);
    return sum;
}

FixedPoint::Value sum_in_order(const FixedPoint& fixed_point, const std::vector<RgbD>& colours) {
    FixedPoint::Value sum{};
    for (const RgbD& c : colours) add_concurrently(sum, fixed_point.from(c));
    return sum;
}

TEST(FixedPoint, SumDoesNotDependOnTheOrder) {
    std::vector<RgbD> colours = random_colours(10'000);
    const FixedPoint fixed_point(sum_of_channels(colours));
    const FixedPoint::Value sum = sum_in_order(fixed_point, colours);
    for (unsigned seed = 0; seed < 5; ++seed) {
        std::shuffle(colours.begin(), colours.end(), std::mt19937(seed));
        EXPECT_EQ(sum_in_order(fixed_point, colours), sum);
    }
}

TEST(FixedPoint, IsAsPreciseAsDoublesForAMillionTerms) {
    const std::vector<RgbD> colours = random_colours(1'000'000);
    const FixedPoint fixed_point(sum_of_channels(colours));
    RgbD exact(0, 0, 0);
    for (const RgbD& c : colours) exact += c;
    const RgbD sum = fixed_point.to_colour(sum_in_order(fixed_point, colours));
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(sum[channel] / exact[channel], 1, 1e-12);
}

// 10^12 equal terms are too many to add: the integer of one term times their number equals their sum.
class FixedPointTerms : public testing::TestWithParam<std::int64_t> {};

TEST_P(FixedPointTerms, NeitherOverflowNorVanish) {
    constexpr double total = 3.7e5;
    const std::int64_t terms = GetParam();
    const std::int64_t term = FixedPoint(total).from(RgbD(total / static_cast<double>(terms), 0, 0))[0];
    ASSERT_GT(term, 0);
    ASSERT_LE(term, std::numeric_limits<std::int64_t>::max() / terms);
    const double sum = FixedPoint(total).to_colour({term * terms, 0, 0}).x;
    EXPECT_NEAR(sum / total, 1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Count, FixedPointTerms,
                         testing::Values(1, 1000, std::int64_t{1} << 40, 1'000'000'000'000,
                                         (std::int64_t{1} << 40) + 1),
                         testing_support::printed_name);

TEST(FixedPoint, KeepsTheTinyAndHugeTotalsOfFloats) {
    for (const double total : {1e-45, 1e-20, 1.0, 1e20, 1e45}) {
        const FixedPoint fixed_point(total);
        const RgbD back = fixed_point.to_colour(fixed_point.from(RgbD(total, total / 3, 0)));
        EXPECT_NEAR(back.x / total, 1, 1e-15);
        EXPECT_NEAR(back.y / (total / 3), 1, 1e-15);
        EXPECT_EQ(back.z, 0);
    }
}

}  // namespace
}  // namespace interflect
