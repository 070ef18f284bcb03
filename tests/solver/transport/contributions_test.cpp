// The sums of contributions do not depend on their order or the number of threads.

#include "interflect/solver/deposit/contributions.h"

#include <gtest/gtest.h>

#include <vector>

namespace interflect {

using namespace detail;
namespace {

using Terms = ContributionSums::ScatterBuffer::Terms;

TEST(ContributionSums, GivesEachElementThePartsOfContributionsThatArriveThere) {
    ContributionSums sums(5);
    sums.begin_step(3);
    ContributionSums::ScatterBuffer buffer(sums);
    const std::uint32_t a = buffer.add_payload({1, 10, 100, 5, 1000}), b = buffer.add_payload({2, 20, 200, 7, 2000});
    buffer.add(ElementIndex(0), a, Terms::both);
    buffer.add(ElementIndex(0), b, Terms::power);
    buffer.add(ElementIndex(2), b, Terms::importance);
    buffer.add(ElementIndex(4), a, Terms::power);  // created during the step
    buffer.flush_all();
    EXPECT_EQ(sums.take(0), (Contribution{3, 30, 300, 12, 1000}));
    EXPECT_EQ(sums.take(1), (Contribution{0, 0, 0, 0, 0}));
    EXPECT_EQ(sums.take(2), (Contribution{0, 0, 0, 0, 2000}));
    EXPECT_EQ(sums.take(4), (Contribution{1, 10, 100, 5, 0}));
    EXPECT_EQ(sums.take(4), Contribution{}) << "taken";
}

TEST(ContributionSums, HaveTheSameSumsWhereManyElementsArePackedAndOnlySomeReceive) {
    const auto receives = [](std::uint32_t e) { return e % 3 == 1; };
    ContributionSums sums(many_elements);
    sums.begin_step(many_elements, /*has_importance=*/false, RankedBits(many_elements, receives));
    ContributionSums::ScatterBuffer buffer(sums);
    constexpr std::int64_t large = std::int64_t{1} << 60;
    const std::uint32_t a = buffer.add_payload({large, 10, 100, 5}), b = buffer.add_payload({2, 20, large, 7});
    for (const std::uint32_t payload : {a, b, b}) buffer.add(ElementIndex(3001), payload, Terms::power);
    buffer.add(ElementIndex(1), b, Terms::power);
    buffer.flush_all();
    EXPECT_TRUE(sums.is_zero(3000)) << "does not receive";
    EXPECT_TRUE(sums.is_zero(30'004));
    EXPECT_FALSE(sums.is_zero(1));
    EXPECT_EQ(sums.take(3001), (Contribution{large + 4, 50, 2 * large + 100, 19, 0}));
    EXPECT_EQ(sums.take(1), (Contribution{2, 20, large, 7, 0}));
    EXPECT_EQ(sums.take(3000), Contribution{});
    EXPECT_EQ(sums.take(3001), Contribution{}) << "taken";
}

}  // namespace
}  // namespace interflect
