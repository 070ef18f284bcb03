#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "interflect/colour.h"

namespace interflect::inline detail {

/// Non-negative colours as integers in a common unit: their sums do not depend on the order of the terms, so any number
/// of threads gets the same bits. The unit is chosen from the total that can at most arrive, so nothing overflows: with
/// unit = total / 2^61 every partial sum stays below 2^63 even after each term was rounded up, for up to 2^61 terms;
/// 10^12 equal terms still have 2^21 units each.
class FixedPoint {
  public:
    using Value = std::array<std::int64_t, 3>;

    /// @param total  At least the sum of all terms, per channel; finite. Where it is 0, so are all terms.
    explicit FixedPoint(double total) : unit_(total * 0x1p-61), per_unit_(total > 0 ? 1 / unit_ : 0) {}

    /// The nearest integers.
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

/// Adds to a sum to which other threads may add at the same time.
inline void add_concurrently(std::int64_t& sum, std::int64_t term) {
    if (term != 0) std::atomic_ref(sum).fetch_add(term, std::memory_order_relaxed);
}
inline void add_concurrently(FixedPoint::Value& sum, const FixedPoint::Value& term) {
    for (std::size_t c = 0; c < 3; ++c) add_concurrently(sum[c], term[c]);
}

}  // namespace interflect::inline detail
