// Sums and other results of several ranks, here threads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "interflect/base/sums/rank_sums.h"
#include "tests/support/thread_ranks.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using testing::Lt;

class Table {
  public:
    Table(std::size_t elements, std::size_t terms) : terms_(terms), sums_(elements * terms, 0) {}
    std::size_t terms() const { return terms_; }
    std::size_t elements() const { return sums_.size() / terms_; }
    std::int64_t& at(std::size_t e, std::size_t t) { return sums_[e * terms_ + t]; }
    bool is_zero(std::size_t e) const {
        return std::all_of(&sums_[e * terms_], &sums_[e * terms_] + terms_, [](std::int64_t sum) { return sum == 0; });
    }
    void read(std::size_t e, std::span<std::int64_t> row) const {
        std::copy_n(&sums_[e * terms_], terms_, row.begin());
    }
    void take(std::size_t e, std::span<std::int64_t> row) {
        read(e, row);
        std::fill_n(&sums_[e * terms_], terms_, 0);
    }
    void add(std::size_t e, std::span<const std::int64_t> row) {
        for (std::size_t t = 0; t < terms_; ++t) sums_[e * terms_ + t] += row[t];
    }
    bool operator==(const Table&) const = default;

  private:
    std::size_t terms_;
    std::vector<std::int64_t> sums_;
};

/// Returns positive and negative numbers of 1 to 60 bits in one of `sparsity` elements; some blocks are empty.
Table random_table(std::size_t elements, std::size_t terms, unsigned sparsity, unsigned seed) {
    std::mt19937_64 random(seed);
    Table table(elements, terms);
    for (std::size_t e = 0; e < elements; ++e) {
        if (e / 256 % 3 == 1 || random() % sparsity != 0) continue;
        for (std::size_t t = 0; t < terms; ++t)
            table.at(e, t) = static_cast<std::int64_t>(random()) >> (4 + random() % 60);  // also 0 and negative ones
    }
    return table;
}

Table unpacked(const PackedSums& packed, std::size_t elements, std::size_t terms) {
    Table table(elements, terms);
    const std::span<const std::byte> part = packed.bytes();
    PackedSums::unpack(std::span(&part, 1), 0, elements, terms,
                       [&](std::size_t e, std::span<const std::int64_t> row) { table.add(e, row); });
    return table;
}

PackedSums pack(const Table& table) {
    return {0, table.elements(), table.terms(), [&](std::size_t e, std::span<std::int64_t> row) {
                table.read(e, row);
                return true;
            }};
}

TEST(PackedSums, AreUnpackedAsTheyWere) {
    for (const std::size_t elements : {0u, 1u, 64u, 1000u, 40'000u})
        for (const unsigned sparsity : {1u, 20u}) {
            const Table table = random_table(elements, 5, sparsity, 7);
            EXPECT_EQ(unpacked(pack(table), elements, 5), table) << elements << " elements";
        }
}

TEST(PackedSums, HoldTheLargestAndTheSmallestNumber) {
    Table table(3, 2);
    table.at(1, 0) = std::numeric_limits<std::int64_t>::max();
    table.at(2, 0) = table.at(2, 1) = std::numeric_limits<std::int64_t>::min();
    EXPECT_EQ(unpacked(pack(table), 3, 2), table);
}

TEST(PackedSums, TakeFewBytesForFewElementsAndSmallNumbers) {
    Table table(64'000, 5);
    EXPECT_THAT(pack(table).bytes().size(), Lt(64'000 / 7)) << "a bit for an element";
    for (std::size_t e = 0; e < 64'000; e += 64) table.at(e, 3) = 1000;
    EXPECT_THAT(pack(table).bytes().size(), Lt(64'000 / 7 + 1000 * 8)) << "widths and two bytes for a block";
}

TEST(RankSums, AreTheSumsOfAllRanksInEachOfThem) {
    constexpr std::size_t elements = 70'001, terms = 5;
    for (const int count : {1, 2, 3, 5}) {
        Table expected(elements, terms);
        for (int r = 0; r < count; ++r) {
            const Table of_rank = random_table(elements, terms, 2, static_cast<unsigned>(r));
            std::vector<std::int64_t> row(terms);
            for (std::size_t e = 0; e < elements; ++e) {
                of_rank.read(e, row);
                expected.add(e, row);
            }
        }
        ThreadRanks(count).run([&](Ranks& ranks) {
            Table table = random_table(elements, terms, 2, static_cast<unsigned>(ranks.rank()));
            add_over_ranks(ranks, elements, table);
            EXPECT_EQ(table, expected) << ranks.rank() << " of " << count;
        });
    }
}

TEST(DividedWork, HasTheResultsOfOneProcess) {
    constexpr std::size_t items = 7, size = 3;
    const auto work = [](std::size_t item, std::span<double> values) {
        for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<double>(100 * item + i);
    };
    const std::vector<double> alone = divide_over_ranks<double>(nullptr, items, size, work);
    EXPECT_EQ(alone.at(3 * size + 2), 302);
    for (const int count : {1, 2, 4, 9})
        ThreadRanks(count).run(
            [&](Ranks& ranks) { EXPECT_EQ(divide_over_ranks<double>(&ranks, items, size, work), alone) << count; });
}

TEST(DividedWork, SumsHaveTheBitsOfOneProcess) {
    constexpr std::size_t count = 10'000, grain = 64;
    const auto sum_of = [](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += 1 / (1.0 + static_cast<double>(i));  // depends on the order
        return sum;
    };
    const double alone = parallel_sum(count, grain, 0.0, sum_of);
    EXPECT_NE(alone, parallel_sum(count, 2 * grain, 0.0, sum_of)) << "the test would see another order";
    for (const int ranks_count : {1, 2, 3})
        ThreadRanks(ranks_count).run([&](Ranks& ranks) {
            EXPECT_EQ(parallel_sum(&ranks, count, grain, 0.0, sum_of), alone);
        });
}

}  // namespace
}  // namespace interflect
