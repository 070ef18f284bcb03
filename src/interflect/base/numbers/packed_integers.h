#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "interflect/base/memory/stable_array.h"

namespace interflect::detail {

/// Sums of integers, in rows of 4 or 5 terms. A term takes 8 bytes, or 6 in packed rows. Packed rows have the upper 16
/// bits of their sums in another array, of which few pages are in use: in units of FixedPoint, a sum exceeds 48 bits
/// only with 2^-13 of the total. Several threads may access different rows.
class PackedIntegers {
  public:
    static constexpr std::size_t most_terms = 5;
    using Row = std::array<std::int64_t, most_terms>;
    /// Address space per row [bytes].
    static constexpr std::size_t reserved_per_row = most_terms * (sizeof(std::uint64_t) + sizeof(std::uint16_t));

    explicit PackedIntegers(std::size_t rows)
        : words_(most_terms * rows), upper_(most_terms * rows, false), has_upper_(rows / rows_per_mark + 1, false) {}

    /// All sums must be 0. @param terms  4 or 5.
    void set_layout(std::size_t terms, bool is_packed) {
        terms_ = terms;
        row_words_ = is_packed ? terms - 1 : most_terms;
    }
    std::size_t terms() const { return terms_; }

    void prefetch(std::size_t row) const { __builtin_prefetch(word(row), 1); }
    void add(std::size_t row, const Row& numbers) {
        if (is_packed()) return add_packed(row, numbers);
        std::uint64_t* const words = word(row);
        for (std::size_t t = 0; t < most_terms; ++t) words[t] += static_cast<std::uint64_t>(numbers[t]);
    }
    bool is_packed() const { return row_words_ != most_terms; }
    /// May return false for a row of zeros among rows of large sums.
    bool is_zero(std::size_t row) const { return is_packed() ? is_packed_zero(row) : is_unpacked_zero(row); }
    /// Equals is_zero() unless is_packed().
    bool is_unpacked_zero(std::size_t row) const {
        const std::uint64_t* const words = &words_[row * most_terms];
        return (words[0] | words[1] | words[2] | words[3] | words[4]) == 0;
    }
    Row get(std::size_t row) const {
        const std::uint64_t* const words = word(row);
        Row numbers{};
        if (!is_packed()) {
            for (std::size_t t = 0; t < most_terms; ++t) numbers[t] = static_cast<std::int64_t>(words[t]);
            return numbers;
        }
        for (std::size_t t = 0; t + 1 < terms_; ++t) numbers[t] = static_cast<std::int64_t>(words[t] & lower_bits);
        numbers[terms_ - 1] = static_cast<std::int64_t>(last_term(words));
        if (may_have_upper(row))
            for (std::size_t t = 0; t < terms_; ++t)
                numbers[t] = static_cast<std::int64_t>(static_cast<std::uint64_t>(numbers[t]) |
                                                       std::uint64_t{upper_[row * most_terms + t]} << 48);
        return numbers;
    }
    Row take(std::size_t row) {
        const Row numbers = get(row);
        clear(row);
        return numbers;
    }
    void clear(std::size_t row) {
        std::uint64_t* const words = word(row);
        words[0] = words[1] = words[2] = 0;
        if (row_words_ > 3) words[3] = 0;
        if (!is_packed())
            words[4] = 0;
        else if (may_have_upper(row))
            for (std::size_t t = 0; t < terms_; ++t)
                // Unneeded writes would allocate pages
                if (std::uint16_t& upper = upper_[row * most_terms + t]; upper != 0) upper = 0;
    }
    /// Frees the memory of rows that are 0.
    void release(std::size_t begin, std::size_t end) { words_.release(begin * row_words_, end * row_words_); }

  private:
    static constexpr std::size_t rows_per_mark = 1024;
    static constexpr std::uint64_t lower_bits = (std::uint64_t{1} << 48) - 1;

    bool is_packed_zero(std::size_t row) const {
        const std::uint64_t* const words = word(row);
        const std::uint64_t any = words[0] | words[1] | words[2] | (row_words_ > 3 ? words[3] : 0);
        return any == 0 && !may_have_upper(row);
    }
    bool may_have_upper(std::size_t row) const { return has_upper_[row / rows_per_mark] != 0; }
    std::uint64_t* word(std::size_t row) { return &words_[row * row_words_]; }
    const std::uint64_t* word(std::size_t row) const { return &words_[row * row_words_]; }
    /// The last term is in the upper bits of the first three words, the others in the lower bits of one each.
    static std::uint64_t last_term(const std::uint64_t* words) {
        return words[0] >> 48 | words[1] >> 48 << 16 | words[2] >> 48 << 32;
    }

    void add_packed(std::size_t row, const Row& numbers) {
        std::uint64_t* const words = word(row);
        const auto number = [&](std::size_t t) { return static_cast<std::uint64_t>(numbers[t]); };
        const std::uint64_t a = (words[0] & lower_bits) + number(0), b = (words[1] & lower_bits) + number(1),
                            c = (words[2] & lower_bits) + number(2);
        std::uint64_t last = last_term(words), any = a | b | c;
        std::array<std::uint64_t, most_terms> sum{a, b, c};
        if (terms_ == most_terms) {
            sum[3] = words[3] + number(3);
            words[3] = sum[3] & lower_bits;
            any |= sum[3];
        }
        last += number(terms_ - 1);
        sum[terms_ - 1] = last;
        words[0] = (a & lower_bits) | last << 48;
        words[1] = (b & lower_bits) | last >> 16 << 48;
        words[2] = (c & lower_bits) | last >> 32 << 48;
        if ((any | last) >> 48 != 0) add_upper(row, sum);
    }
    void add_upper(std::size_t row, const std::array<std::uint64_t, most_terms>& sum) {
        std::atomic_ref(has_upper_[row / rows_per_mark]).store(1, std::memory_order_relaxed);
        for (std::size_t t = 0; t < terms_; ++t)
            upper_[row * most_terms + t] = static_cast<std::uint16_t>(upper_[row * most_terms + t] + (sum[t] >> 48));
    }

    std::size_t terms_ = most_terms, row_words_ = most_terms;
    StableArray<std::uint64_t> words_;
    StableArray<std::uint16_t> upper_;
    StableArray<std::uint8_t> has_upper_;  // whether some of 1024 rows may have other upper bits than 0
};

}  // namespace interflect::detail
