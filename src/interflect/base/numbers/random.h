#pragma once

#include <array>
#include <cstdint>

namespace interflect::detail {

/// Hashes two words with the finaliser of SplitMix64 (Steele et al. 2014).
constexpr std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t x = a + 0x9e3779b97f4a7c15ull * (b + 1);
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// Returns four independent uniform words: Philox4x32-10 (Salmon et al. 2011).
std::array<std::uint32_t, 4> random_words(std::uint64_t key, std::uint64_t index);

/// Maps a word to the middle of one of 2^23 equal cells of (0, 1).
constexpr float unit_float(std::uint32_t word) { return (static_cast<float>(word >> 9) + 0.5f) * 0x1p-23f; }

/// Returns a number in [0, 1), with 53 random bits.
double random_double(std::uint64_t key, std::uint64_t index);

}  // namespace interflect::detail
