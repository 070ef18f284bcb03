// Systematic allocation of rays to leaves in proportion to q (Eq. 3, Prikryl et al. 2000).

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "interflect/solver/sampling/ray_allocation.h"

namespace interflect {

using namespace detail;
namespace {

std::vector<float> some_weights() {
    std::mt19937_64 random(1);
    std::lognormal_distribution<float> weight(0, 3);
    std::vector<float> q(1000);
    for (std::size_t s = 0; s < q.size(); ++s) q[s] = s % 3 == 0 ? 0 : weight(random);
    return q;
}

/// Returns the first ray of every source, then the total number of rays.
std::vector<std::int64_t> allocate_rays(const std::vector<float>& q, std::int64_t rays, double offset) {
    const RayAllocation allocation(q, rays, offset);
    std::vector<std::int64_t> first(q.size() + 1, 0);
    std::int64_t given = 0;
    const auto note = [&](std::size_t s, std::int64_t first_of_s, std::int64_t from, std::int64_t to) {
        EXPECT_EQ(first_of_s, given);
        EXPECT_EQ(from, given);
        EXPECT_GT(to, from);
        given = first[s + 1] = to;
    };
    allocation.for_each_source(0, rays, note);
    for (std::size_t s = 0; s < q.size(); ++s) first[s + 1] = std::max(first[s], first[s + 1]);
    return first;
}

/// Largest number below 1, the upper limit of random offsets.
const double largest_offset = std::nextafter(1.0, 0.0);

TEST(AllocateRays, GivesEachSourceItsShareRoundedUpOrDown) {
    const std::vector<float> q = some_weights();
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
    const std::vector<float> q{0.1f, 3.7f, 0, 1.9f, 0.003f};
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
        EXPECT_EQ(allocate_rays({0, 0, 5, 0}, 100, offset), (std::vector<std::int64_t>{0, 0, 0, 100, 100}));
}

TEST(AllocateRays, NamesTheSourcesOfAnyRange) {
    const std::vector<float> q = some_weights();
    constexpr std::int64_t rays = 5000;
    const RayAllocation allocation(q, rays, 0.3);
    const std::vector<std::int64_t> first = allocate_rays(q, rays, 0.3);
    for (const std::int64_t length : {1, 7, 1000})
        for (std::int64_t begin = 0; begin + length <= rays; begin += 37) {
            std::int64_t next = begin;
            allocation.for_each_source(begin, begin + length,
                                       [&](std::size_t s, std::int64_t first_of_s, std::int64_t from, std::int64_t to) {
                                           EXPECT_EQ(first_of_s, first[s]);
                                           EXPECT_EQ(from, next);
                                           EXPECT_LE(to, first[s + 1]);
                                           next = to;
                                       });
            EXPECT_EQ(next, begin + length);
        }
}

TEST(AllocateRays, GivesNobodyAnyWhereAllWeightsAre0) {
    const RayAllocation allocation(std::vector<float>(3, 0.0f), 100, 0.5);
    EXPECT_EQ(allocation.q_sum(), 0);
    EXPECT_EQ(allocation.block_count(), 0u);
}

}  // namespace
}  // namespace interflect
