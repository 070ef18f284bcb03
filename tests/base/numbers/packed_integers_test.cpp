// Packed rows have the same sums as rows of 8 bytes a term.

#include "interflect/base/numbers/packed_integers.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace interflect {

using namespace detail;
namespace {

using Row = PackedIntegers::Row;

TEST(PackedIntegers, HaveTheSumsOfAllTerms) {
    constexpr std::size_t rows = 3000;
    for (const bool is_packed : {false, true})
        for (const std::size_t terms : {4u, 5u}) {
            PackedIntegers sums(rows);
            sums.set_layout(terms, is_packed);
            std::vector<Row> expected(rows, Row{});
            std::mt19937_64 random(1);
            for (int i = 0; i < 20'000; ++i) {
                const std::size_t row = random() % rows / 7 * 7;
                Row numbers{};
                for (std::size_t t = 0; t < terms; ++t) {
                    // From 8 to 60 bits. Contributions are not negative, but sums of negative numbers are exact, too
                    numbers[t] = static_cast<std::int64_t>(random()) >> (4 + random() % 53);
                    expected[row][t] += numbers[t];
                }
                sums.add(row, numbers);
            }
            for (std::size_t row = 0; row < rows; ++row) {
                EXPECT_TRUE(expected[row] == Row{} || !sums.is_zero(row)) << row;
                EXPECT_EQ(sums.get(row), expected[row]) << row;
                EXPECT_EQ(sums.take(row), expected[row]) << row;
                EXPECT_EQ(sums.get(row), Row{}) << row << " taken";
            }
        }
}

TEST(PackedIntegers, AreZeroOnlyIfAllBitsAre) {
    for (const std::int64_t number :
         {std::int64_t{1}, std::int64_t{1} << 47, std::int64_t{1} << 48, std::int64_t{1} << 61})
        for (std::size_t term = 0; term < 5; ++term) {
            PackedIntegers sums(10);
            sums.set_layout(5, true);
            EXPECT_TRUE(sums.is_zero(3));
            Row row{};
            row[term] = number;
            sums.add(3, row);
            EXPECT_FALSE(sums.is_zero(3)) << number << " in term " << term;
            EXPECT_EQ(sums.get(2), Row{});
            EXPECT_EQ(sums.get(4), Row{});
            sums.clear(3);
            EXPECT_EQ(sums.get(3), Row{});
        }
}

}  // namespace
}  // namespace interflect
