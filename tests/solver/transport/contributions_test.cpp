// The sums of contributions do not depend on their order or the number of threads.

#include "interflect/solver/deposit/contributions.h"

#include <gtest/gtest.h>

#include <vector>

#include "interflect/base/threads/parallel.h"

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

TEST(ContributionSums, AreTheSameWhateverThreadsBringThem) {
    constexpr std::size_t elements = 1000, payloads = 7, rays = 200'000;
    std::vector<Contribution> contributions;
    for (std::int64_t s = 0; s < static_cast<std::int64_t>(payloads); ++s)
        contributions.push_back({s, 3 * s, -s, s * s, 1 + s});
    std::vector<Contribution> expected(elements, Contribution{});
    ContributionSums sums(elements);
    sums.begin_step(elements);
    const auto element = [](std::size_t ray) { return ElementIndex(ray * ray % elements); };
    for (std::size_t ray = 0; ray < rays; ++ray)
        for (std::size_t c = 0; c < contributions[0].size(); ++c)
            expected[element(ray)][c] += contributions[ray % payloads][c];
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

}  // namespace
}  // namespace interflect
