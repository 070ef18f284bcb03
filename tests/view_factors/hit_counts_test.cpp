// Factors and standard errors of a row from counted hits, by hand.
//
// Seen to fail without the resolution of a count, with the error of one replicate, and if the spread of rays counts.

#include "interflect/view_factors/rays/hit_counts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace interflect::detail {
namespace {

TEST(HitCounter, CountsEachColumnAndStartsAgain) {
    HitCounter counter(3);
    for (const std::uint32_t column : {2u, 0u, 2u}) counter.add(column);
    ReplicateHits hits;
    counter.finish(hits);
    ASSERT_EQ(hits.columns.size(), 2u);
    EXPECT_EQ(hits.columns[0].column, 2u);
    EXPECT_EQ(hits.columns[0].hits, 2u);
    counter.finish(hits);
    EXPECT_TRUE(hits.columns.empty());
}

TEST(EstimateRow, DividesHitsByRays) {
    // Column 1: 3 and 5 of 10 rays each. The hits of a replicate have the variance 2, both together 4.
    const ReplicateHits replicates[] = {{{{1, 3}, {4, 7}}, 10}, {{{1, 5}, {4, 5}}, 10}};
    const std::vector<EstimatedFactor> row = estimate_row(replicates);
    ASSERT_EQ(row.size(), 2u);
    EXPECT_EQ(row[0].column, 1u);
    EXPECT_FLOAT_EQ(row[0].value, 0.4f);
    EXPECT_FLOAT_EQ(row[0].error, std::sqrt(4.0f + 1) / 20);
}

TEST(EstimateRow, HasTheErrorOfOneHitWithoutSpread) {
    const ReplicateHits replicates[] = {{{{0, 10}}, 10}, {{{0, 10}}, 10}};
    EXPECT_FLOAT_EQ(estimate_row(replicates)[0].value, 1);
    EXPECT_FLOAT_EQ(estimate_row(replicates)[0].error, 1.0f / 20);
}

TEST(EstimateRow, IgnoresTheSpreadOfRays) {
    // Twice the rays, twice the hits: the ratio does not vary.
    const ReplicateHits replicates[] = {{{{0, 5}}, 10}, {{{0, 10}}, 20}};
    EXPECT_FLOAT_EQ(estimate_row(replicates)[0].value, 0.5f);
    EXPECT_FLOAT_EQ(estimate_row(replicates)[0].error, 1.0f / 30);
}

TEST(EstimateRow, IsEmptyWithoutRays) { EXPECT_TRUE(estimate_row(std::vector<ReplicateHits>(32)).empty()); }

}  // namespace
}  // namespace interflect::detail
