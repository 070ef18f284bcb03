#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/memory/stable_array.h"

namespace interflect::detail {

/// Terms of a contribution: three channels of power, squared luminance, importance.
using Contribution = std::array<std::int64_t, 5>;
inline constexpr std::size_t power_terms = 4, importance_term = 4;

/// Sums of contributions by element. They are integers, so they do not depend on the order of additions. Each thread
/// collects contributions in bins, one for each region of the forest, and adds a full bin to the sums under the
/// region's lock.
class ContributionSums {
  public:
    /// Address space per element [bytes].
    static constexpr std::size_t reserved_per_element(std::size_t groups) {
        return sizeof(Contribution) + 3 * groups * sizeof(std::int64_t);
    }

    explicit ContributionSums(std::size_t capacity, std::size_t groups = 0)
        : sums_(capacity), group_terms_(3 * groups), group_sums_(capacity * group_terms_) {}

    void begin_step(std::size_t elements);
    void clear(std::size_t elements) {
        for (std::size_t e = 0; e < elements; ++e) clear_one(e);
    }
    /// Returns the number of terms for read() and add(): those of a contribution, then the power of all groups.
    std::size_t terms() const { return Contribution().size() + group_terms_; }
    void read(std::size_t element, std::span<std::int64_t> terms) const {
        const Contribution& sum = sums_[element];
        std::copy(sum.begin(), sum.end(), terms.begin());
        for (std::size_t i = 0; i < group_terms_; ++i) terms[sum.size() + i] = group_sums_[element * group_terms_ + i];
    }
    void add(std::size_t element, std::span<const std::int64_t> terms) {
        Contribution& sum = sums_[element];
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += terms[c];
        for (std::size_t i = 0; i < group_terms_; ++i) group_sums_[element * group_terms_ + i] += terms[sum.size() + i];
    }
    void clear_one(std::size_t element) {
        sums_[element] = {};
        for (std::size_t i = 0; i < group_terms_; ++i) group_sums_[element * group_terms_ + i] = 0;
    }
    bool is_zero(std::size_t element) const {
        const Contribution& sum = sums_[element];  // the comparison of arrays would call memcmp()
        return (sum[0] | sum[1] | sum[2] | sum[3] | sum[4]) == 0;
    }
    Contribution take(std::size_t element) { return std::exchange(sums_[element], {}); }
    std::array<std::int64_t, 3> take(std::size_t element, std::size_t group) {
        std::array<std::int64_t, 3> power{};
        for (std::size_t c = 0; c < 3; ++c) power[c] = std::exchange(group_sum(element, group)[c], 0);
        return power;
    }
    std::size_t groups() const { return group_terms_ / 3; }
    void add(std::size_t element, const Contribution& contribution) {
        for (std::size_t c = 0; c < contribution.size(); ++c) sums_[element][c] += contribution[c];
    }
    void add(std::size_t element, std::size_t group, const std::array<std::int64_t, 3>& power) {
        for (std::size_t c = 0; c < 3; ++c) group_sum(element, group)[c] += power[c];
    }
    /// Releases the memory of these elements. Small forests keep it, because clearing new pages is slower than the
    /// additions.
    void release(std::size_t begin, std::size_t end) {
        if (elements_ <= max_kept) return;
        sums_.release(begin, end);
        if (group_terms_ > 0) group_sums_.release(begin * group_terms_, end * group_terms_);
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
            const std::size_t region = element >> sums_->region_shift_ & (regions - 1);
            Bin& bin = bins_[region];
            bin.deposits[bin.count++] = {element, payload & (max_payloads - 1), terms != Terms::importance,
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
            ElementIndex element;
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

    static constexpr std::size_t max_kept = std::size_t{1} << 20;  // largest number of elements whose memory is kept

    std::int64_t* group_sum(std::size_t element, std::size_t group) {
        return &group_sums_[element * group_terms_ + 3 * group];
    }

    StableArray<Contribution> sums_;
    std::size_t group_terms_;
    StableArray<std::int64_t> group_sums_;  // [element][group][channel]
    std::size_t elements_ = 0;
    int region_shift_ = 0;
    std::array<std::mutex, regions> region_locks_;
};

}  // namespace interflect::detail
