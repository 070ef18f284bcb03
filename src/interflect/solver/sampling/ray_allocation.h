#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace interflect::detail {

/// Systematic allocation of N rays to sources, in order. Source s receives N q_s / sum q rays, rounded up or down. The
/// mean over all values of `offset` is exact.
class RayAllocation {
  public:
    static constexpr std::size_t block_sources = 256;

    /// @param q       Weights >= 0, not normalised; must outlive this.
    /// @param rays    Number N of rays, > 0.
    /// @param offset  Uniform random number in [0, 1).
    RayAllocation(std::span<const float> q, std::int64_t rays, double offset);

    double q_sum() const { return q_sum_; }  ///< Sum of the weights; 0: no source receives rays.

    /// Calls body(s, first, from, to) for each source s of the rays [begin, end). `first` is the first ray of s, and
    /// [from, to) are its rays in the range.
    template <class Body>
    void for_each_source(std::int64_t begin, std::int64_t end, const Body& body) const {
        const auto after =
            std::upper_bound(blocks_.begin(), blocks_.end(), begin,
                             [](std::int64_t ray, const SourceBlock& block) { return ray < block.first_ray; });
        for (auto block = static_cast<std::size_t>(after - blocks_.begin()) - 1; block < blocks_.size(); ++block) {
            const bool goes_on = for_each_in_block(block, [&](std::size_t s, std::int64_t first, std::int64_t next) {
                if (next > begin) body(s, first, std::max(first, begin), std::min(next, end));
                return next < end;
            });
            if (!goes_on) return;
        }
    }

    std::size_t block_count() const { return blocks_.size(); }
    static std::size_t block_of(std::size_t source) { return source / block_sources; }
    /// Calls body(s, first, next) for each source s of a block, which has the rays [first, next). Stops if `body`
    /// returns false. Returns the last result.
    template <class Body>
    bool for_each_in_block(std::size_t block, const Body& body) const {
        const std::size_t begin = block * block_sources, end = std::min(q_.size(), begin + block_sources);
        double cumulative = 0;
        std::int64_t first = blocks_[block].first_ray;
        for (std::size_t s = begin; s < end; ++s) {
            if (q_[s] == 0) continue;
            cumulative += q_[s];
            const std::int64_t next = rays_before(blocks_[block].q_before + cumulative);
            if (next > first && !body(s, first, next)) return false;
            first = next;
        }
        return true;
    }

  private:
    struct SourceBlock {
        double q_before;         // sum of the weights of all previous blocks
        std::int64_t first_ray;  // number of rays of all previous blocks
    };
    /// Returns the number of rays before a source, if the sum of the weights before it is `q`.
    std::int64_t rays_before(double q) const {
        const double before = q / q_sum_ * static_cast<double>(rays_) + offset_;
        return std::min(rays_, static_cast<std::int64_t>(before));  // N + offset may round up to N + 1
    }

    std::span<const float> q_;
    std::int64_t rays_;
    double offset_, q_sum_ = 0;
    std::vector<SourceBlock> blocks_;
};

}  // namespace interflect::detail
