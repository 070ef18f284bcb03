#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "interflect/core.h"

namespace interflect::detail {

/// Non-negative colours as integers in units of total / 2^61, for sums independent of order. Even 2^61 terms, each
/// rounded up, stay below 2^63.
class FixedPoint {
  public:
    using Value = std::array<std::int64_t, 3>;

    /// @param total  Upper bound of the sum, per channel; finite, >= 0.
    explicit FixedPoint(double total) : unit_(total * 0x1p-61), per_unit_(total > 0 ? 1 / unit_ : 0) {}

    Value from(const RgbD& c) const {
        return {std::llround(c.x * per_unit_), std::llround(c.y * per_unit_), std::llround(c.z * per_unit_)};
    }
    std::int64_t from(double number) const { return std::llround(number * per_unit_); }
    double to_number(std::int64_t v) const { return static_cast<double>(v) * unit_; }
    RgbD to_colour(const Value& v) const {
        return RgbD(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])) * unit_;
    }

  private:
    double unit_, per_unit_;
};

inline void add_concurrently(std::int64_t& sum, std::int64_t term) {
    if (term != 0) std::atomic_ref(sum).fetch_add(term, std::memory_order_relaxed);
}
inline void add_concurrently(FixedPoint::Value& sum, const FixedPoint::Value& term) {
    for (std::size_t c = 0; c < 3; ++c) add_concurrently(sum[c], term[c]);
}

}  // namespace interflect::detail
