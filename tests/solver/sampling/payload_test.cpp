// Payloads of rays: the largest and the quantiles relative to the mean, in bins of a quarter of an octave. Seen to fail
// if one or all bins count added rays once instead of by their number, if rays of an operand are dropped or not
// counted, or if a quantile may exceed the largest payload.

#include "interflect/solver/sampling/payload.h"

#include <gtest/gtest.h>

#include <cmath>

namespace interflect {

using namespace detail;
namespace {

constexpr double bin_ratio = 1.19;  // ratio of the ends of a bin, 2^(1/4)

TEST(PayloadHistogram, AreOneWhereNothingIsCarriedOrAllRaysCarryTheSame) {
    PayloadHistogram quanta;
    quanta.add(0, 100);
    quanta.add(5, 0);
    EXPECT_EQ(quanta.largest_over_mean(), 1);
    EXPECT_EQ(quanta.quantile_over_mean(0.001), 1);
    quanta.add(3, 1000);
    EXPECT_DOUBLE_EQ(quanta.largest_over_mean(), 1);
    EXPECT_DOUBLE_EQ(quanta.quantile_over_mean(0.001), 1) << "never more than the largest";
}

TEST(PayloadHistogram, HaveTheQuantilesOfAUniformDistribution) {
    PayloadHistogram quanta;
    for (int i = 1; i <= 10'000; ++i) quanta.add(1e-7 * i, 3);
    EXPECT_NEAR(quanta.largest_over_mean(), 2, 1e-3);
    for (const double share : {0.001, 0.1, 0.5, 0.9}) {
        const double exact = 2 * (1 - share);
        EXPECT_GE(quanta.quantile_over_mean(share), exact / bin_ratio) << share;
        EXPECT_LE(quanta.quantile_over_mean(share), exact * bin_ratio) << share;
    }
}

TEST(PayloadHistogram, AFewRaysOfALargeQuantumAreSeenOnlyByTheLargest) {
    PayloadHistogram quanta;
    quanta.add(1, 99'999);
    quanta.add(1000, 1);
    const double mean = (99'999 + 1000) / 1e5;
    EXPECT_NEAR(quanta.largest_over_mean(), 1000 / mean, 1e-9);
    EXPECT_LT(quanta.quantile_over_mean(0.001), bin_ratio / mean);
    EXPECT_NEAR(quanta.quantile_over_mean(0.000001), 1000 / mean, 1e-9);
}

TEST(PayloadHistogram, OfTwoSetsAreThoseOfAllTheirRays) {
    PayloadHistogram all, low, high;
    for (int i = 1; i <= 100; ++i) {
        all.add(i, 7);
        (i <= 60 ? low : high).add(i, 7);
    }
    PayloadHistogram sum;
    sum += PayloadHistogram();
    sum += low;
    sum += high;
    EXPECT_DOUBLE_EQ(sum.largest_over_mean(), all.largest_over_mean());
    for (const double share : {0.01, 0.3, 0.8})
        EXPECT_DOUBLE_EQ(sum.quantile_over_mean(share), all.quantile_over_mean(share));
}

}  // namespace
}  // namespace interflect
