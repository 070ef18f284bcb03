#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/memory/stable_array.h"
#include "interflect/base/numbers/packed_integers.h"
#include "interflect/base/numbers/ranked_bits.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

/// Terms of a contribution: three channels of power, squared luminance, importance.
using Contribution = PackedIntegers::Row;
inline constexpr std::size_t power_terms = 4, importance_term = 4;

/// Sums of contributions by element. They are integers, so they do not depend on the order of additions. Each thread
/// collects contributions in bins, one for each region of the forest, and adds a full bin to the sums under the
/// region's lock.
class ContributionSums {
  public:
    /// Address space per element [bytes].
    static constexpr std::size_t reserved_per_element(std::size_t groups) {
        return PackedIntegers::reserved_per_row + 3 * groups * sizeof(std::int64_t);
    }
    explicit ContributionSums(std::size_t capacity, std::size_t groups = 0)
        : sums_(capacity), group_terms_(3 * groups), group_sums_(capacity * group_terms_) {}

    /// @param has_importance  Whether any contribution has importance.
    /// @param receivers       Elements that may receive contributions; empty: all, also those that the step creates.
    void begin_step(std::size_t elements, bool has_importance = true, RankedBits receivers = {}) {
        elements_ = elements;
        sums_.set_layout(has_importance ? importance_term + 1 : power_terms, elements >= many_elements);
        receivers_ = std::move(receivers);
        all_receive_ = receivers_.empty();
        region_shift_ = static_cast<int>(std::bit_width(rows_before(elements) / regions));
    }
    void clear(std::size_t elements) {
        for (std::size_t e = 0; e < elements; ++e)
            if (receives(e)) clear_one(e);
    }
    /// Returns the number of terms for read() and add(): those of a contribution, then the power of all groups.
    std::size_t terms() const { return sums_.terms() + group_terms_; }
    void read(std::size_t element, std::span<std::int64_t> terms) const {
        if (!receives(element)) {
            std::ranges::fill(terms, 0);
            return;
        }
        const Contribution sum = sums_.get(row(element));
        const auto groups = std::copy_n(sum.begin(), sums_.terms(), terms.begin());
        for (std::size_t i = 0; i < group_terms_; ++i)
            groups[static_cast<std::ptrdiff_t>(i)] = group_sums_[row(element) * group_terms_ + i];
    }
    void add(std::size_t element, std::span<const std::int64_t> terms) {
        Contribution sum{};
        std::copy_n(terms.begin(), sums_.terms(), sum.begin());
        sums_.add(row(element), sum);
        for (std::size_t i = 0; i < group_terms_; ++i)
            group_sums_[row(element) * group_terms_ + i] += terms[sums_.terms() + i];
    }
    void clear_one(std::size_t element) {
        if (!receives(element)) return;
        sums_.clear(row(element));
        for (std::size_t i = 0; i < group_terms_; ++i) group_sums_[row(element) * group_terms_ + i] = 0;
    }
    bool is_zero(std::size_t element) const { return !receives(element) || sums_.is_zero(row(element)); }
    /// Whether the sums of all elements are stored in the simplest way; is_simple_zero() then equals is_zero().
    bool are_simple() const { return all_receive_ && !sums_.is_packed(); }
    bool is_simple_zero(std::size_t element) const { return sums_.is_unpacked_zero(element); }
    Contribution take(std::size_t element) {
        if (!receives(element)) return {};
        return sums_.take(row(element));
    }
    std::array<std::int64_t, 3> take(std::size_t element, std::size_t group) {
        std::array<std::int64_t, 3> power{};
        if (!receives(element)) return power;
        for (std::size_t c = 0; c < 3; ++c) power[c] = std::exchange(group_sum(element, group)[c], 0);
        return power;
    }
    std::size_t groups() const { return group_terms_ / 3; }
    void add(std::size_t element, const Contribution& contribution) { sums_.add(row(element), contribution); }
    void add(std::size_t element, std::size_t group, const std::array<std::int64_t, 3>& power) {
        for (std::size_t c = 0; c < 3; ++c) group_sum(element, group)[c] += power[c];
    }
    /// Releases the memory of these elements, whose sums are 0. Small forests keep it, because clearing new pages is
    /// slower than the additions.
    void release(std::size_t begin, std::size_t end) {
        if (elements_ < many_elements) return;
        const std::size_t first = rows_before(begin), last = rows_before(end);
        sums_.release(first, last);
        if (group_terms_ > 0) group_sums_.release(first * group_terms_, last * group_terms_);
    }

    /// The bins of a thread, and the payloads to which their deposits refer.
    class ScatterBuffer {
      public:
        explicit ScatterBuffer(ContributionSums& sums) : sums_(&sums) {}

        /// Stores a payload and returns its index.
        /// @param contribution    Contribution of one ray.
        /// @param power_by_group  Three channels per group; empty: 0.
        std::uint32_t add_payload(const Contribution& contribution, std::span<const std::int64_t> power_by_group = {}) {
            contributions_.push_back(contribution);
            group_contributions_.insert(group_contributions_.end(), power_by_group.begin(), power_by_group.end());
            group_contributions_.resize(contributions_.size() * sums_->group_terms_);
            return static_cast<std::uint32_t>(contributions_.size() - 1);
        }
        const Contribution& contribution(std::uint32_t payload) const { return contributions_[payload]; }

        enum class Terms { power, importance, both };
        void add(ElementIndex element, std::uint32_t payload, Terms terms) {
            const auto row = static_cast<std::uint32_t>(sums_->row(element));
            const std::size_t region = row >> sums_->region_shift_ & (regions - 1);
            Bin& bin = bins_[region];
            bin.deposits[bin.count++] = {row, payload & (max_payloads - 1), terms != Terms::importance,
                                         terms != Terms::power};
            if (bin.count == bin.deposits.size()) flush(region);
        }
        /// Call between tasks. Flushes all bins if many payloads are stored.
        void release_payloads() {
            if (contributions_.size() >= enough_payloads) flush_all();
        }
        /// Adds all bins to the sums. Invalidates the indices of payloads, as release_payloads() may.
        void flush_all() {
            for (std::size_t region = 0; region < regions; ++region) flush(region);
            contributions_.clear();
            group_contributions_.clear();
        }

      private:
        struct Deposit {
            std::uint32_t row;
            std::uint32_t payload : 30;
            std::uint32_t power : 1, importance : 1;
        };
        struct Bin {
            std::size_t count = 0;
            std::array<Deposit, 127> deposits;  // a bin then fills 1 KiB
        };
        void flush(std::size_t region);
        void add_groups(const Bin& bin);

        ContributionSums* sums_;
        std::vector<Contribution> contributions_;
        std::vector<std::int64_t> group_contributions_;
        std::vector<Bin> bins_ = std::vector<Bin>(regions);
    };

  private:
    static constexpr std::size_t regions = 64;
    static constexpr std::uint32_t max_payloads = 1u << 30;  // width of Deposit::payload
    static constexpr std::size_t enough_payloads = 8192;     // a quarter of a second-level cache

    bool receives(std::size_t element) const { return all_receive_ || receivers_[static_cast<std::uint32_t>(element)]; }
    std::size_t rows_before(std::size_t element) const {
        return all_receive_ ? element : receivers_.rank(static_cast<std::uint32_t>(element));
    }
    /// Returns the row of an element that receives contributions.
    std::size_t row(std::size_t element) const {
        assert(receives(element));
        return rows_before(element);
    }
    std::int64_t* group_sum(std::size_t element, std::size_t group) {
        return &group_sums_[row(element) * group_terms_ + 3 * group];
    }

    PackedIntegers sums_;
    std::size_t group_terms_;
    StableArray<std::int64_t> group_sums_;  // [row][group][channel]
    std::size_t elements_ = 0;
    RankedBits receivers_;  // ranks of its members are their rows; empty: rows are elements
    bool all_receive_ = true;
    int region_shift_ = 0;
    std::array<std::mutex, regions> region_locks_;
};

}  // namespace interflect::detail
