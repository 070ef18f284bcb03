#include "interflect/solver/carried.h"

#include "interflect/base/parallel.h"

namespace interflect::inline detail {

Totals all_carried(const TransportStep& step, const RayAllocation& allocation, const Carried& carried) {
    constexpr std::size_t blocks_at_once = 16;
    return parallel_sum(allocation.block_count(), blocks_at_once, Totals(), [&](std::size_t begin, std::size_t end) {
        Totals sum;
        for (std::size_t block = begin; block < end; ++block)
            allocation.for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                const auto source = static_cast<std::uint32_t>(s);
                const auto count = static_cast<double>(next - first);
                if (step.carries_power()) {
                    const RgbD power = carried.power(source);
                    sum.power += power * count;
                    sum.square += std::pow(luminance(power), 2) * count;
                    sum.quanta.add(channel_sum(power), next - first);
                }
                if (step.carries_importance()) {
                    const double importance = carried.importance(source);
                    sum.importance += importance * count;
                    sum.importance_square += importance * importance * count;
                }
                return true;
            });
        return sum;
    });
}

}  // namespace interflect::inline detail
