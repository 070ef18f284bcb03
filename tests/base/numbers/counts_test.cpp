// Counts of any size are exact, whatever memory they take.

#include "interflect/base/numbers/counts.h"

#include <gtest/gtest.h>

namespace interflect {

using namespace detail;
namespace {

TEST(Counts, AreExactBelowAndAbove16Bits) {
    Counts counts;
    counts.resize(10'000);
    counts.add(1, 65'535);
    counts.add(2, 65'535);
    counts.add(2, 1);
    counts.add(9'999, Counts::end - 2);
    counts.add(9'999, 1);
    EXPECT_EQ(counts[0], 0u);
    EXPECT_EQ(counts[1], 65'535u);
    EXPECT_EQ(counts[2], 65'536u);
    EXPECT_EQ(counts[9'999], Counts::end - 1);
}

TEST(Counts, AreZeroWhereTheyAreNew) {
    Counts counts;
    counts.resize(5000);
    counts.add(4999, 1'000'000);
    counts.resize(4999);
    counts.resize(20'000);
    for (const std::size_t i : {4999u, 5000u, 19'999u}) EXPECT_EQ(counts[i], 0u) << i;
    EXPECT_EQ(counts.size(), 20'000u);
}

}  // namespace
}  // namespace interflect
