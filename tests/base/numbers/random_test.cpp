#include "interflect/base/numbers/random.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::chi_square_test;
using testing_support::false_alarm;

TEST(RandomWords, AreThoseOfPhilox) {
    // Known answer for counter 0 and key 0, from the distribution of Random123 (Salmon et al. 2011).
    EXPECT_EQ(random_words(0, 0), (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
}

TEST(RandomWords, DependOnAllBitsOfKeyAndIndex) {
    std::set<std::array<std::uint32_t, 4>> words{random_words(0, 0)};
    for (int bit = 0; bit < 64; ++bit) {
        words.insert(random_words(std::uint64_t{1} << bit, 0));
        words.insert(random_words(0, std::uint64_t{1} << bit));
    }
    EXPECT_EQ(words.size(), 129u);
}

TEST(UnitFloat, NeverReachesTheEndsOfTheInterval) {
    EXPECT_GT(unit_float(0), 0.0f);
    EXPECT_LT(unit_float(0xffffffffu), 1.0f);
    EXPECT_LT(unit_float(0), unit_float(1u << 9));
}

TEST(RandomDouble, IsUniform) {
    constexpr std::size_t cells = 64, count = 100'000;
    std::vector<double> observed(cells, 0.0);
    for (std::uint64_t i = 0; i < count; ++i) {
        const double x = random_double(7, i);
        ASSERT_TRUE(x >= 0 && x < 1);
        ++observed[static_cast<std::size_t>(x * cells)];
    }
    const std::vector<double> expected(cells, static_cast<double>(count) / cells);
    EXPECT_GT(chi_square_test(observed, expected), false_alarm);
}

TEST(Mix, SeparatesNeighbours) {
    std::set<std::uint64_t> values;
    for (std::uint64_t a = 0; a < 100; ++a)
        for (std::uint64_t b = 0; b < 100; ++b) values.insert(mix(a, b));
    EXPECT_EQ(values.size(), 10'000u);
}

}  // namespace
}  // namespace interflect
