#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace interflect::inline detail {

/// A set of numbers below a bound, which knows how many of its members are less than any of them: the members are the
/// keys of a table that holds nothing for the others. 2 bits for each number below the bound.
class RankedBits {
  public:
    RankedBits() = default;  ///< No number is a member.
    /// @param members  Ascending, each once, all of them below `bound` and fewer than 2^32.
    RankedBits(std::size_t bound, const std::vector<std::uint32_t>& members) : words_(bound / 64 + 1) {
        for (const std::uint32_t member : members) words_[member / 64].bits |= std::uint64_t{1} << member % 64;
        std::uint32_t before = 0;
        for (Word& word : words_) {
            word.before = before;
            before += static_cast<std::uint32_t>(std::popcount(word.bits));
        }
    }

    bool operator[](std::uint32_t number) const {
        return number / 64 < words_.size() && (words_[number / 64].bits >> number % 64 & 1u);
    }
    /// How many members are less than `number`, which is one.
    std::uint32_t rank(std::uint32_t number) const {
        const Word& word = words_[number / 64];
        const std::uint64_t lower = (std::uint64_t{1} << number % 64) - 1;
        return word.before + static_cast<std::uint32_t>(std::popcount(word.bits & lower));
    }
    std::size_t memory() const { return words_.capacity() * sizeof(Word); }  ///< [bytes]

  private:
    struct Word {
        std::uint64_t bits = 0;
        std::uint32_t before = 0;  // members in the words before it
    };
    std::vector<Word> words_;
};

}  // namespace interflect::inline detail
