#include "interflect/solver/sampling/ray_allocation.h"

#include <cassert>
#include <cmath>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

RayAllocation::RayAllocation(std::span<const float> q, std::int64_t rays, double offset)
    : q_(q), rays_(rays), offset_(offset), blocks_((q.size() + block_sources - 1) / block_sources) {
    assert(rays > 0 && offset >= 0 && offset < 1);
    constexpr std::size_t blocks_per_task = 32;
    parallel_for_ranges(blocks_.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            double sum = 0;
            for (const float w : q_.subspan(b * block_sources, std::min(block_sources, q_.size() - b * block_sources)))
                sum += w;
            blocks_[b].q_before = sum;
        }
    });
    for (SourceBlock& block : blocks_) {
        const double sum = block.q_before;
        block.q_before = q_sum_;
        q_sum_ += sum;
    }
    assert(std::isfinite(q_sum_));
    if (!(q_sum_ > 0)) {
        blocks_.clear();
        return;
    }
    for (SourceBlock& block : blocks_) block.first_ray = rays_before(block.q_before);
}

}  // namespace interflect::detail
