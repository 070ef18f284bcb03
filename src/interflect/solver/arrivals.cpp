#include "interflect/solver/arrivals.h"

#include <bit>

namespace interflect {

void Arrivals::begin(std::size_t elements) {
    elements_ = elements;
    region_shift_ = static_cast<int>(std::bit_width(elements / regions));
}

void Arrivals::ScatterBuffer::flush(std::size_t region) {
    Bin& bin = bins_[region];
    const std::scoped_lock lock(arrivals_->region_locks_[region]);
    for (std::size_t i = 0; i < bin.count; ++i) __builtin_prefetch(&arrivals_->sums_[bin.arrivals[i].element], 1);
    for (std::size_t i = 0; i < bin.count; ++i) {
        const Arrival& a = bin.arrivals[i];
        const Contribution& contribution = contributions_[a.source];
        Contribution& sum = arrivals_->sums_[a.element];
        const std::int64_t power = -static_cast<std::int64_t>(a.power);  // a mask: all ones or all zeros
        for (std::size_t c = 0; c < power_terms; ++c) sum[c] += contribution[c] & power;
        sum[importance_term] += contribution[importance_term] & -static_cast<std::int64_t>(a.importance);
    }
    bin.count = 0;
}

}  // namespace interflect
