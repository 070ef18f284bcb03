#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

/// Set of integers in two bits per integer below `bound`. The rank of a member, found in O(1), indexes compact tables.
class RankedBits {
  public:
    RankedBits() = default;
    /// @param members  Ascending, unique, below `bound`; fewer than 2^32.
    template <class Index>
    RankedBits(std::size_t bound, const std::vector<Index>& members) : words_(bound / 64 + 1) {
        for (const std::uint32_t member : members) words_[member / 64].bits |= std::uint64_t{1} << member % 64;
        set_ranks();
    }
    /// Contains the numbers below `bound` for which is_member(number) is true. Several threads call it.
    template <class IsMember>
    requires std::predicate<IsMember, std::uint32_t> RankedBits(std::size_t bound, const IsMember& is_member)
        : words_(bound / 64 + 1) {
        parallel_for_indices(words_.size(), [&](std::size_t i) {
            for (std::size_t number = 64 * i; number < std::min(bound, 64 * i + 64); ++number)
                words_[i].bits |= std::uint64_t{is_member(static_cast<std::uint32_t>(number))} << number % 64;
        });
        set_ranks();
    }

    bool empty() const { return words_.empty(); }

    bool operator[](std::uint32_t number) const {
        return number / 64 < words_.size() && (words_[number / 64].bits >> number % 64 & 1u);
    }
    /// Returns the number of smaller members.
    std::uint32_t rank(std::uint32_t number) const {
        const Word& word = words_[number / 64];
        const std::uint64_t lower = (std::uint64_t{1} << number % 64) - 1;
        return word.before + static_cast<std::uint32_t>(std::popcount(word.bits & lower));
    }
    std::size_t memory() const { return words_.capacity() * sizeof(Word); }  ///< [bytes]

  private:
    struct Word {
        std::uint64_t bits = 0;
        std::uint32_t before = 0;  // members in the preceding words
    };
    void set_ranks() {
        std::uint32_t before = 0;
        for (Word& word : words_) {
            word.before = before;
            before += static_cast<std::uint32_t>(std::popcount(word.bits));
        }
    }

    std::vector<Word> words_;
};

}  // namespace interflect::detail
