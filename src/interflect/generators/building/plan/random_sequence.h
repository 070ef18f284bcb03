#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/base/numbers/random.h"

namespace interflect::detail::building {

/// Random numbers that depend on the key alone.
class RandomSequence {
  public:
    explicit RandomSequence(std::uint64_t key) : key_(key) {}

    /// Uniform in (0, 1).
    float uniform() {
        if (used_ == words_.size()) {
            words_ = random_words(key_, index_++);
            used_ = 0;
        }
        return unit_float(words_[used_++]);
    }
    float between(float low, float high) { return low + (high - low) * uniform(); }
    bool chance(float probability) { return uniform() < probability; }
    /// Uniform in 0 ... n - 1; 0 < n << 2^23.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(uniform() * static_cast<float>(n)); }
    template <class T>
    const T& pick(std::span<const T> choices) {
        return choices[below(static_cast<std::uint32_t>(choices.size()))];
    }

  private:
    std::uint64_t key_, index_ = 0;
    std::array<std::uint32_t, 4> words_{};
    std::size_t used_ = 4;
};

}  // namespace interflect::detail::building
