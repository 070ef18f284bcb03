// How rays are handed to leaves: systematically, in proportion to q (Eq. 3, Prikryl et al. 2000).

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "interflect/solver/transport.h"

namespace interflect {
namespace {

std::vector<double> some_weights() {
    std::mt19937_64 random(1);
    std::lognormal_distribution<double> weight(0, 3);
    std::vector<double> q(1000);
    for (std::size_t s = 0; s < q.size(); ++s) q[s] = s % 3 == 0 ? 0 : weight(random);
    return q;
}

/// The largest number below 1: no random offset is larger.
const double largest_offset = std::nextafter(1.0, 0.0);

TEST(AllocateRays, GivesEachSourceItsShareRoundedUpOrDown) {
    const std::vector<double> q = some_weights();
    const double sum = std::accumulate(q.begin(), q.end(), 0.0);
    for (const std::int64_t rays :
         {std::int64_t{1}, std::int64_t{7}, std::int64_t{12'345}, std::int64_t{1'000'000'000'000}})
        for (const double offset : {0.0, 0.25, 0.5, 0.999, largest_offset}) {
            const std::vector<std::int64_t> first = allocate_rays(q, rays, offset);
            ASSERT_EQ(first.size(), q.size() + 1);
            EXPECT_EQ(first.front(), 0);
            EXPECT_EQ(first.back(), rays);
            for (std::size_t s = 0; s < q.size(); ++s) {
                const double share = static_cast<double>(rays) * (q[s] / sum);
                const auto count = static_cast<double>(first[s + 1] - first[s]);
                ASSERT_LT(std::abs(count - share), 1 + 1e-3) << "source " << s << ", offset " << offset;
                ASSERT_TRUE(q[s] > 0 || count == 0);
            }
        }
}

TEST(AllocateRays, GivesTheExactShareInTheMeanOverOffsets) {
    const std::vector<double> q{0.1, 3.7, 0, 1.9, 0.003};
    constexpr std::int64_t rays = 10;
    constexpr int offsets = 10'000;
    const double sum = std::accumulate(q.begin(), q.end(), 0.0);
    std::vector<double> mean(q.size(), 0.0);
    for (int k = 0; k < offsets; ++k) {
        const auto first = allocate_rays(q, rays, (k + 0.5) / offsets);
        for (std::size_t s = 0; s < q.size(); ++s) mean[s] += static_cast<double>(first[s + 1] - first[s]) / offsets;
    }
    for (std::size_t s = 0; s < q.size(); ++s) EXPECT_NEAR(mean[s], rays * q[s] / sum, 2.0 / offsets);
}

TEST(AllocateRays, GivesNothingToSourcesWithoutWeight) {
    for (const double offset : {0.0, 0.5, largest_offset})
        EXPECT_EQ(allocate_rays(std::vector<double>{0, 0, 5, 0}, 100, offset),
                  (std::vector<std::int64_t>{0, 0, 0, 100, 100}));
}

}  // namespace
}  // namespace interflect
