#include "interflect/solver/sampling/payload.h"

#include <algorithm>
#include <cmath>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

PayloadTotals total_payload(const RayPlan& plan, const RayAllocation& allocation, const Payload& payload) {
    constexpr std::size_t blocks_per_task = 16;
    return parallel_sum(
        allocation.block_count(), blocks_per_task, PayloadTotals(), [&](std::size_t begin, std::size_t end) {
            PayloadTotals sum;
            for (std::size_t block = begin; block < end; ++block)
                allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                    const auto source = static_cast<std::uint32_t>(s);
                    const auto count = static_cast<double>(next - first);
                    if (plan.carries_power()) {
                        const RgbD power = payload.power(source);
                        sum.power += power * count;
                        sum.square += std::pow(luminance(power), 2) * count;
                        sum.histogram.add(channel_sum(power), next - first);
                    }
                    if (plan.carries_importance()) {
                        const double importance = payload.importance(source);
                        sum.importance += importance * count;
                        sum.importance_square += importance * importance * count;
                    }
                    return true;
                });
            return sum;
        });
}

void PayloadHistogram::add(double power, std::int64_t rays) {
    if (!(power > 0) || rays == 0) return;
    if (rays_.empty()) rays_.resize(bins, 0);
    const double bin = std::floor(bins_per_octave * std::log2(power)) + middle_bin;
    rays_[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1.0))] += rays;
    power_ += power * static_cast<double>(rays);
    largest_ = std::max(largest_, power);
    count_ += rays;
}

PayloadHistogram& PayloadHistogram::operator+=(const PayloadHistogram& other) {
    if (other.rays_.empty()) return *this;
    rays_.resize(bins, 0);
    for (std::size_t i = 0; i < rays_.size(); ++i) rays_[i] += other.rays_[i];
    power_ += other.power_;
    largest_ = std::max(largest_, other.largest_);
    count_ += other.count_;
    return *this;
}

double PayloadHistogram::largest_over_mean() const {
    return count_ > 0 ? largest_ / power_ * static_cast<double>(count_) : 1;
}

double PayloadHistogram::quantile_over_mean(double share) const {
    if (count_ == 0) return 1;
    const double exceeding = share * static_cast<double>(count_);
    double above = 0;
    std::size_t bin = rays_.size();
    while (bin > 0 && above + static_cast<double>(rays_[bin - 1]) <= exceeding)
        above += static_cast<double>(rays_[--bin]);
    const double upper_end = std::exp2((static_cast<double>(bin) - middle_bin) / bins_per_octave);
    return std::min(upper_end, largest_) / power_ * static_cast<double>(count_);
}

}  // namespace interflect::detail
