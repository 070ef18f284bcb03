#include "interflect/base/numbers/points.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "interflect/base/numbers/random.h"

namespace interflect::detail {

namespace {

constexpr int word_bits = 32;
using Directions = std::array<std::uint32_t, word_bits>;

/// Returns the direction numbers of one dimension, bit-reversed.
/// @param inner  Inner coefficients of the primitive polynomial.
/// @param m      Initial odd numbers of the recurrence.
constexpr Directions sobol_directions(int degree, std::uint32_t inner, std::array<std::uint32_t, 3> m) {
    std::array<std::uint32_t, word_bits> v{};  // v[i] = m[i] * 2^(31 - i)
    for (int i = 0; i < word_bits; ++i) {
        if (degree == 0) {
            v[i] = 1u << (word_bits - 1 - i);
        } else if (i < degree) {
            v[i] = m[i] << (word_bits - 1 - i);
        } else {
            v[i] = v[i - degree] ^ (v[i - degree] >> degree);
            for (int k = 1; k < degree; ++k)
                if ((inner >> (degree - 1 - k)) & 1u) v[i] ^= v[i - k];
        }
    }
    Directions reversed{};
    for (int i = 0; i < word_bits; ++i)
        for (int b = 0; b < word_bits; ++b)
            if ((v[i] >> b) & 1u) reversed[i] |= 1u << (word_bits - 1 - b);
    return reversed;
}

constexpr std::array<Directions, 4> directions = {sobol_directions(0, 0, {}), sobol_directions(1, 0, {1}),
                                                  sobol_directions(2, 1, {1, 3}), sobol_directions(3, 1, {1, 3, 1})};

/// Sobol' words of the 256 values of one byte of an index, by value and dimension.
using WordsOfByte = std::array<std::array<std::uint32_t, 4>, 256>;

constexpr WordsOfByte words_of_byte(std::size_t shift) {
    WordsOfByte words{};
    for (std::size_t byte = 1; byte < words.size(); ++byte) {
        const auto lowest = static_cast<std::size_t>(std::countr_zero(byte));
        for (std::size_t d = 0; d < 4; ++d)
            words[byte][d] = words[byte & (byte - 1)][d] ^ directions[d][shift + lowest];
    }
    return words;
}

constexpr std::array<WordsOfByte, 2> words_of_bytes{words_of_byte(0), words_of_byte(8)};

/// Returns the four bit-reversed Sobol' words of an index in natural order.
std::array<std::uint32_t, 4> sobol_words(std::uint32_t index) {
    std::array<std::uint32_t, 4> words{};
    for (std::size_t d = 0; d < 4; ++d)
        words[d] = words_of_bytes[0][index & 0xff][d] ^ words_of_bytes[1][index >> 8 & 0xff][d];
    for (std::uint32_t bits = index & ~0xffffu; bits != 0; bits &= bits - 1)
        for (std::size_t d = 0; d < 4; ++d) words[d] ^= directions[d][static_cast<std::size_t>(std::countr_zero(bits))];
    return words;
}

/// Owen scrambling of bit-reversed numbers: each bit depends only on itself and lower bits. Form of Laine and Karras
/// 2011, constants of N. Vegdahl 2021.
constexpr std::uint32_t nested_permutation(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

/// Writes `count` points from index `first` to the block from `begin`, in Gray-code order: aligned runs of 2^k points
/// are the same sets as in natural order.
void fill_sobol(std::uint64_t key, std::uint32_t first, std::size_t begin, std::size_t count, PointBlock& block) {
    std::array<std::uint32_t, PointBlock::capacity> word;
    const std::array<std::uint32_t, 4> first_word = sobol_words(first ^ (first >> 1));
    for (std::size_t d = 0; d < 4; ++d) {
        word[0] = first_word[d];
        for (std::size_t i = 1; i < count; ++i)
            word[i] = word[i - 1] ^
                      directions[d][static_cast<std::size_t>(std::countr_zero(first + static_cast<std::uint32_t>(i)))];
        const auto seed = static_cast<std::uint32_t>(mix(key, d) >> 32);
        for (std::size_t i = 0; i < count; ++i)
            block.coordinate[d][begin + i] = unit_float(reverse_bits(nested_permutation(word[i], seed)));
    }
}

}  // namespace

void fill_points(PointSet set, std::uint64_t key, std::uint64_t first, std::size_t count, PointBlock& block) {
    assert(count <= PointBlock::capacity);
    if (set == PointSet::random) {
        for (std::size_t i = 0; i < count; ++i) {
            const auto words = random_words(key, first + i);
            for (std::size_t d = 0; d < 4; ++d) block.coordinate[d][i] = unit_float(words[d]);
        }
        return;
    }
    // A sequence ends after 2^32 points; the next has a new scrambling.
    for (std::size_t begin = 0; begin < count;) {
        const std::uint64_t index = first + begin, left = (std::uint64_t{1} << word_bits) - (index & 0xffffffffu);
        const auto run = static_cast<std::size_t>(std::min<std::uint64_t>(left, count - begin));
        fill_sobol(mix(key, index >> word_bits), static_cast<std::uint32_t>(index), begin, run, block);
        begin += run;
    }
}

std::array<float, 4> shuffled_point(std::uint64_t key, std::uint32_t index) {
    constexpr std::uint32_t shuffled_bits = 0xffffu;
    constexpr std::uint64_t shuffle_key = 4;  // the dimensions have keys 0 to 3
    const auto shuffle_seed = static_cast<std::uint32_t>(mix(key, shuffle_key) >> 32);
    const std::uint32_t shuffled =
        (reverse_bits(nested_permutation(reverse_bits(index), shuffle_seed)) & shuffled_bits) |
        (index & ~shuffled_bits);
    const std::array<std::uint32_t, 4> words = sobol_words(shuffled);
    std::array<float, 4> point;
    for (std::size_t d = 0; d < 4; ++d) {
        const auto seed = static_cast<std::uint32_t>(mix(key, d) >> 32);
        point[d] = unit_float(reverse_bits(nested_permutation(words[d], seed)));
    }
    return point;
}

}  // namespace interflect::detail
