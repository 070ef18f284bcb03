#include "interflect/solver/deposit/contributions.h"

namespace interflect::detail {

void ContributionSums::ScatterBuffer::flush(std::size_t region) {
    Bin& bin = bins_[region];
    const std::scoped_lock lock(sums_->region_locks_[region]);
    for (std::size_t i = 0; i < bin.count; ++i) sums_->sums_.prefetch(bin.deposits[i].row);
    for (std::size_t i = 0; i < bin.count; ++i) {
        const Deposit& a = bin.deposits[i];
        Contribution contribution = contributions_[a.payload];
        const std::int64_t power = -static_cast<std::int64_t>(a.power);  // all ones or all zeros
        for (std::size_t c = 0; c < power_terms; ++c) contribution[c] &= power;
        contribution[importance_term] &= -static_cast<std::int64_t>(a.importance);
        sums_->sums_.add(a.row, contribution);
    }
    if (sums_->group_terms_ > 0) add_groups(bin);
    bin.count = 0;
}

void ContributionSums::ScatterBuffer::add_groups(const Bin& bin) {
    const std::size_t terms = sums_->group_terms_;
    for (std::size_t i = 0; i < bin.count; ++i) __builtin_prefetch(&sums_->group_sums_[bin.deposits[i].row * terms], 1);
    for (std::size_t i = 0; i < bin.count; ++i) {
        const Deposit& a = bin.deposits[i];
        if (!a.power) continue;
        const std::int64_t* power = &group_contributions_[a.payload * terms];
        std::int64_t* sum = &sums_->group_sums_[a.row * terms];
        for (std::size_t c = 0; c < terms; ++c) sum[c] += power[c];
    }
}

}  // namespace interflect::detail
