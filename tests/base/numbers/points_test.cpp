// Stratification and uniformity of the points that define rays. Seen to fail (scripts/mutation-test) when all
// dimensions share one scrambling.

#include "interflect/base/numbers/points.h"
#include "tests/support/parameter_names.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "tests/support/statistics.h"

namespace interflect {

using namespace detail;
namespace {

using testing_support::bonferroni;
using testing_support::chi_square_test;
using testing_support::false_alarm;
using testing_support::z_test;

using Point = std::array<float, 4>;
using Digits = std::array<int, 4>;  // number of binary digits by which each dimension is divided

std::vector<Point> points(PointSet set, std::uint64_t key, std::uint64_t first, std::size_t count) {
    std::vector<Point> result;
    PointBlock block;
    for (std::size_t begin = 0; begin < count; begin += PointBlock::capacity) {
        const std::size_t size = std::min(PointBlock::capacity, count - begin);
        fill_points(set, key, first + begin, size, block);
        for (std::size_t i = 0; i < size; ++i)
            result.push_back(
                {block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i], block.coordinate[3][i]});
    }
    return result;
}

/// Counts the points in each non-empty cell.
std::map<Digits, int> cell_counts(const std::vector<Point>& points, const Digits& digits) {
    std::map<Digits, int> counts;
    for (const Point& p : points) {
        Digits cell{};
        for (std::size_t d = 0; d < 4; ++d) cell[d] = static_cast<int>(std::ldexp(p[d], digits[d]));
        ++counts[cell];
    }
    return counts;
}

/// Returns whether every cell holds the same number of points.
bool is_stratified(const std::vector<Point>& points, const Digits& digits) {
    const std::map<Digits, int> counts = cell_counts(points, digits);
    const std::size_t cells = std::size_t{1} << (digits[0] + digits[1] + digits[2] + digits[3]);
    if (counts.size() != cells) return false;
    for (const auto& [cell, count] : counts)
        if (static_cast<std::size_t>(count) * cells != points.size()) return false;
    return true;
}

class PointSets : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(Both, PointSets, testing::Values(PointSet::sobol, PointSet::random),
                         testing_support::printed_name);

TEST_P(PointSets, LieInTheOpenUnitCube) {
    for (const Point& p : points(GetParam(), 3, 0, 5000))
        for (const float x : p) ASSERT_TRUE(x > 0 && x < 1);
}

TEST_P(PointSets, AreTheSameInWhateverOrderTheyAreAsked) {
    const std::vector<Point> all = points(GetParam(), 5, 0, 3000);
    for (const std::uint64_t first : {0, 1, 7, 1000, 1023, 1024, 1025, 2047})
        for (const std::size_t count : {1, 2, 500}) {
            const std::vector<Point> some = points(GetParam(), 5, first, count);
            for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(some[i], all[first + i]) << first << " + " << i;
        }
}

TEST_P(PointSets, DifferFromKeyToKey) {
    EXPECT_NE(points(GetParam(), 1, 0, 1), points(GetParam(), 2, 0, 1));
    EXPECT_NE(points(GetParam(), 1, 0, 1), points(GetParam(), std::uint64_t{1} << 40, 0, 1));
}

// Each point, over many keys, is uniform in every pair of dimensions. This makes the solver unbiased.
TEST_P(PointSets, EachPointIsUniformOverTheKeys) {
    constexpr std::size_t side = 8, keys = 8192;
    std::vector<double> p_values;
    for (const std::uint64_t index : {0, 1, 6, 1000})
        for (std::size_t d = 0; d < 4; ++d)
            for (std::size_t e = 0; e < d; ++e) {
                std::vector<double> observed(side * side, 0.0);
                for (std::uint64_t key = 0; key < keys; ++key) {
                    const Point p = points(GetParam(), key, index, 1)[0];
                    ++observed[static_cast<std::size_t>(p[d] * side) * side + static_cast<std::size_t>(p[e] * side)];
                }
                const std::vector<double> expected(side * side, static_cast<double>(keys) / (side * side));
                p_values.push_back(chi_square_test(observed, expected));
            }
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

TEST(RandomPoints, HaveTheMomentsOfUniformNumbers) {
    constexpr std::size_t count = 100'000;
    std::vector<double> p_values;
    const std::vector<Point> all = points(PointSet::random, 11, 0, count);
    for (std::size_t d = 0; d < 4; ++d) {
        double sum = 0, squares = 0;
        for (const Point& p : all) {
            sum += p[d];
            squares += (p[d] - 0.5) * (p[d] - 0.5);
        }
        p_values.push_back(z_test(sum / count, 0.5, std::sqrt(1.0 / 12 / count)));
        p_values.push_back(z_test(squares / count, 1.0 / 12, std::sqrt(1.0 / 180 / count)));
    }
    EXPECT_GT(bonferroni(p_values), false_alarm);
}

// Sobol' points with primitive polynomials of degree 0, 1, 2, 3 are a (t, 4)-sequence with t = 0 + 0 + 1 + 2. In every
// aligned block of 2^k points, each elementary interval of volume 2^(3 - k), of any shape, holds exactly 8.
TEST(SobolPoints, AlignedBlocksAreStratifiedInFourDimensions) {
    constexpr int k = 9, t = 3, divided = k - t;
    for (const std::uint64_t block : {0, 1, 5, 1'000'000}) {
        const std::vector<Point> all = points(PointSet::sobol, 17 + block, block << k, std::size_t{1} << k);
        for (int a = 0; a <= divided; ++a)
            for (int b = 0; a + b <= divided; ++b)
                for (int c = 0; a + b + c <= divided; ++c)
                    ASSERT_TRUE(is_stratified(all, {a, b, c, divided - a - b - c}))
                        << "block " << block << ", digits " << a << ' ' << b << ' ' << c;
    }
}

// The first two dimensions, the origin of a ray, are a (0, 2)-sequence: one point in each interval of 2^-k.
TEST(SobolPoints, OriginsAreStratifiedOnePointACell) {
    constexpr int k = 8;
    for (const std::uint64_t block : {0, 3, 77'777}) {
        const std::vector<Point> all = points(PointSet::sobol, 23, block << k, std::size_t{1} << k);
        for (int a = 0; a <= k; ++a) ASSERT_TRUE(is_stratified(all, {a, k - a, 0, 0})) << block << ": " << a;
    }
}

TEST(SobolPoints, EachDimensionByItselfIsStratifiedOnePointACell) {
    constexpr int k = 10;
    const std::vector<Point> all = points(PointSet::sobol, 29, 0, std::size_t{1} << k);
    for (const Digits digits : {Digits{k, 0, 0, 0}, {0, k, 0, 0}, {0, 0, k, 0}, {0, 0, 0, k}})
        EXPECT_TRUE(is_stratified(all, digits));
}

TEST(RandomPoints, AreNotStratified) {  // the tests above can fail
    EXPECT_FALSE(is_stratified(points(PointSet::random, 1, 0, 256), {4, 4, 0, 0}));
}

TEST(SobolPoints, GoOnWithAnotherSequenceAfterTheLast) {
    constexpr std::uint64_t last = (std::uint64_t{1} << 32) - 1;
    const std::vector<Point> across = points(PointSet::sobol, 31, last - 4, 10);
    for (std::uint64_t i = 0; i < 10; ++i) EXPECT_EQ(across[i], points(PointSet::sobol, 31, last - 4 + i, 1)[0]);
    EXPECT_NE(across[5], points(PointSet::sobol, 31, 0, 1)[0]);
    EXPECT_TRUE(is_stratified(points(PointSet::sobol, 31, last + 1, 256), {4, 4, 0, 0}));
}

std::vector<Point> shuffled_points(std::uint64_t key, std::uint32_t first, std::uint32_t count) {
    std::vector<Point> result;
    for (std::uint32_t i = 0; i < count; ++i) result.push_back(shuffled_point(key, first + i));
    return result;
}

TEST(ShuffledPoints, AlignedBlocksAreStratifiedInFourDimensions) {
    constexpr int k = 9, divided = k - 3;
    for (const std::uint32_t block : {0, 1, 5, 1'000'000}) {
        const std::vector<Point> all = shuffled_points(17 + block, block << k, 1u << k);
        for (int a = 0; a <= divided; ++a)
            for (int b = 0; a + b <= divided; ++b) ASSERT_TRUE(is_stratified(all, {a, b, divided - a - b, 0}));
        for (int a = 0; a <= k; ++a) ASSERT_TRUE(is_stratified(all, {a, k - a, 0, 0})) << block << ": " << a;
    }
}

/// Counts the points, out of 256 of two sequences, for which the first digits of one dimension agree.
int agreements(const std::vector<Point>& one, const std::vector<Point>& other, std::size_t dimension) {
    int count = 0;
    for (std::size_t i = 0; i < one.size(); ++i) count += (one[i][dimension] < 0.5f) == (other[i][dimension] < 0.5f);
    return count;
}

// With scrambling alone, the same half of a sequence has the first digit 0 for every key, so two dimensions of
// different sequences would cover only half of their square. With shuffling, 128 +- 8 agree.
TEST(ShuffledPoints, OfDifferentKeysAreIndependent) {
    for (std::uint64_t key = 0; key < 64; ++key)
        for (std::size_t d = 0; d < 4; ++d) {
            const int count = agreements(shuffled_points(2 * key, 0, 256), shuffled_points(2 * key + 1, 0, 256), d);
            EXPECT_NEAR(count, 128, 6 * 8) << key;
            const int unshuffled =
                agreements(points(PointSet::sobol, 2 * key, 0, 256), points(PointSet::sobol, 2 * key + 1, 0, 256), d);
            EXPECT_TRUE(unshuffled == 0 || unshuffled == 256) << "the test can fail";
        }
}

}  // namespace
}  // namespace interflect
