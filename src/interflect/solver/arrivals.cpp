#include "interflect/solver/arrivals.h"

#include <bit>

namespace interflect {

void Arrivals::begin(std::size_t elements) {
    elements_ = elements;
    region_shift_ = static_cast<int>(std::bit_width(elements / regions));
}

void Arrivals::Sorter::hand_on(std::size_t region) {
    Lot& lot = lots_[region];
    const std::scoped_lock lock(arrivals_->at_work_[region]);
    for (std::size_t i = 0; i < lot.count; ++i) __builtin_prefetch(&arrivals_->sums_[lot.arrivals[i].element], 1);
    for (std::size_t i = 0; i < lot.count; ++i) {
        const Arrival& a = lot.arrivals[i];
        const Load& load = loads_[a.source];
        Load& sum = arrivals_->sums_[a.element];
        const std::int64_t power = -static_cast<std::int64_t>(a.power);  // a mask: all ones or all zeros
        for (std::size_t c = 0; c < power_terms; ++c) sum[c] += load[c] & power;
        sum[importance_term] += load[importance_term] & -static_cast<std::int64_t>(a.importance);
    }
    lot.count = 0;
}

}  // namespace interflect
