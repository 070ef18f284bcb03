#include "interflect/base/threads/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace interflect {

using namespace detail;
namespace {

TEST(ParallelForRanges, CoversEachIndexOnceInAlignedRanges) {
    constexpr std::size_t grain = 64;
    for (const std::size_t count : {0, 1, 63, 64, 65, 1000, 100'001}) {
        std::vector<std::atomic<int>> visits(count);
        std::atomic<int> misaligned{0};
        parallel_for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
            if (begin % grain != 0 || begin >= end || (end != count && end != begin + grain)) ++misaligned;
            for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        EXPECT_EQ(misaligned, 0) << count;
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(visits[i], 1) << i << " of " << count;
    }
}

TEST(ParallelSum, AddsInTheOrderOfTheRanges) {
    EXPECT_EQ(parallel_sum(0, 64, 0.0, [](std::size_t, std::size_t) { return 1.0; }), 0);
    const auto term = [](std::size_t i) { return 1.0 / static_cast<double>(i + 1); };
    const auto some = [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += term(i);
        return sum;
    };
    double expected = 0;
    for (std::size_t begin = 0; begin < 100'001; begin += 64)
        expected += some(begin, std::min<std::size_t>(begin + 64, 100'001));
    EXPECT_EQ(parallel_sum(100'001, 64, 0.0, some), expected) << "to the last bit";
}

}  // namespace
}  // namespace interflect
