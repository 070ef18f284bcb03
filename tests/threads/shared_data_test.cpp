// Data that several threads change together: forests, sums of colours, sums of contributions.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <thread>
#include <vector>

#include "interflect/base/numbers/fixed_point.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/deposit/contributions.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;

TEST(Forest, ThreadsThatSubdivideTogetherMakeTheForestThatOneMakes) {
    const Scene scene = closed_box({1, 2, 3}, 3, {Material{"grey", Rgb(0.5f), Rgb(1)}});
    // Refines to level 4 around random points; threads with the same seed compete for the same elements.
    const auto refine = [](ElementForest& forest, unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (int i = 0; i < 500; ++i) {
            ElementIndex e(random() % 8);
            const Parameters p{uniform(random), uniform(random)};
            Cell cell;
            for (int level = 0; level < 4; ++level) {
                const unsigned k = cell.child_at(p, false);
                cell = cell.child(k, false);
                e = forest.subdivide(e) + k;
            }
        }
    };
    constexpr std::size_t capacity = 1 << 16;
    ElementForest by_one(scene, capacity), by_many(scene, capacity);
    for (unsigned t = 0; t < 4; ++t) refine(by_one, t % 2);
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < 4; ++t) threads.emplace_back([&, t] { refine(by_many, t % 2); });
    for (std::thread& thread : threads) thread.join();
    by_one.put_in_order(by_one.patch_count());
    by_many.put_in_order(by_many.patch_count());
    ASSERT_EQ(by_one.size(), by_many.size());
    for (ElementIndex e{0}; e < by_one.size(); ++e) {
        EXPECT_EQ(by_one.patch(e), by_many.patch(e));
        EXPECT_EQ(by_one.path(e), by_many.path(e));
        EXPECT_EQ(by_one.parent(e), by_many.parent(e));
        EXPECT_EQ(by_one.first_child(e), by_many.first_child(e));
    }
}

TEST(FixedPoint, SumDoesNotDependOnTheThreads) {
    constexpr std::size_t terms = 100'000;
    const FixedPoint fixed_point(terms);
    const auto term = [&](std::size_t i) {
        return fixed_point.from(RgbD(random_double(1, i), random_double(2, i), 0));
    };
    FixedPoint::Value expected{};
    for (std::size_t i = 0; i < terms; ++i)
        for (std::size_t c = 0; c < expected.size(); ++c) expected[c] += term(i)[c];
    std::array<FixedPoint::Value, 3> sums{};
    parallel_for_ranges(terms, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) add_concurrently(sums[1], term(i));
    });
    EXPECT_EQ(sums[1], expected);
    EXPECT_EQ(sums[0], FixedPoint::Value{});
    EXPECT_EQ(sums[2], FixedPoint::Value{});
}

/// @param unit  Factor of the contributions.
void expect_sums_of_threads(std::size_t elements, std::int64_t unit) {
    constexpr std::size_t payloads = 7, rays = 200'000;
    std::vector<Contribution> contributions;
    for (std::int64_t s = 0; s < static_cast<std::int64_t>(payloads); ++s)
        contributions.push_back({unit * s, 3 * unit * s, -s, unit * s * s, 1 + s});
    std::vector<Contribution> expected(elements, Contribution{});
    ContributionSums sums(elements);
    sums.begin_step(elements);
    const auto element = [=](std::size_t ray) { return ElementIndex(ray * ray % elements); };
    for (std::size_t ray = 0; ray < rays; ++ray)
        for (std::size_t c = 0; c < contributions[0].size(); ++c)
            expected[element(ray)][c] += contributions[ray % payloads][c];
    using Terms = ContributionSums::ScatterBuffer::Terms;
    parallel_for_ranges(rays, 10'000, [&](std::size_t begin, std::size_t end) {
        ContributionSums::ScatterBuffer buffer(sums);
        for (std::size_t ray = begin; ray < end; ++ray) {
            buffer.add(element(ray), buffer.add_payload(contributions[ray % payloads]), Terms::both);
            buffer.release_payloads();
        }
        buffer.flush_all();
    });
    for (std::size_t e = 0; e < elements; ++e) EXPECT_EQ(sums.take(e), expected[e]) << e;
}

TEST(ContributionSums, AreTheSameWhateverThreadsBringThem) { expect_sums_of_threads(1000, 1); }

/// The sums exceed the 48 bits that packed rows have for a term.
TEST(ContributionSums, AreTheSameWhateverThreadsBringThemIfPacked) {
    expect_sums_of_threads(many_elements, std::int64_t{1} << 46);
}

}  // namespace
}  // namespace interflect
