#include "interflect/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace interflect {
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

}  // namespace
}  // namespace interflect
