#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace interflect::detail {

/// Many counts below 2^48, most of them below 2^16. A count takes 2 bytes, or 6 where it or one near it is larger.
class Counts {
  public:
    /// Several threads may add to counts of different blocks of this size.
    static constexpr std::size_t block = 4096;
    static constexpr std::uint64_t end = std::uint64_t{1} << 48;

    std::size_t size() const { return lower_.size(); }
    /// New counts are 0.
    void resize(std::size_t size) {
        lower_.resize(size, 0);
        upper_.resize((size + block - 1) / block);
        if (size % block == 0 || upper_.back().empty()) return;
        upper_.back().resize(size % block);
        upper_.back().resize(block);
    }
    std::uint64_t operator[](std::size_t i) const {
        const std::vector<std::uint32_t>& upper = upper_[i / block];
        return upper.empty() ? lower_[i] : std::uint64_t{upper[i % block]} << bits | lower_[i];
    }
    void add(std::size_t i, std::uint64_t count) {
        const std::uint64_t sum = lower_[i] + count;
        lower_[i] = static_cast<std::uint16_t>(sum);
        if (sum <= std::numeric_limits<std::uint16_t>::max()) return;
        std::vector<std::uint32_t>& upper = upper_[i / block];
        if (upper.empty()) upper.resize(block);
        upper[i % block] += static_cast<std::uint32_t>(sum >> bits);
    }

  private:
    static constexpr int bits = 16;
    std::vector<std::uint16_t> lower_;
    std::vector<std::vector<std::uint32_t>> upper_;  // counts over 2^16, by block; empty if all are 0
};

}  // namespace interflect::detail
