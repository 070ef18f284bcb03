#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "interflect/base/colour.h"

namespace interflect {

/// Non-negative colours as integers in a common unit: their sums do not depend on the order of the terms, so any number
/// of threads gets the same bits. The unit is chosen from the total that can at most arrive, so nothing overflows: with
/// unit = total / 2^61 every partial sum stays below 2^63 even after each term was rounded up, for up to 2^61 terms;
/// 10^12 equal terms still have 2^21 units each.
class FixedPoint {
  public:
    using Value = std::array<std::int64_t, 3>;

    /// @param total  At least the sum of all terms, per channel; > 0 and finite.
    explicit FixedPoint(double total) : unit_(total * 0x1p-61), per_unit_(1 / unit_) {}

    /// The nearest integers.
    Value from(const RgbD& c) const {
        return {std::llround(c.x * per_unit_), std::llround(c.y * per_unit_), std::llround(c.z * per_unit_)};
    }
    RgbD to_colour(const Value& v) const {
        return RgbD(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])) * unit_;
    }

  private:
    double unit_, per_unit_;
};

/// One sum for each of many receivers, to which all threads may add at the same time.
class ConcurrentSums {
  public:
    explicit ConcurrentSums(std::size_t size) : sums_(size) {}

    void add(std::size_t i, const FixedPoint::Value& term) {
        for (std::size_t c = 0; c < 3; ++c)
            if (term[c] != 0) std::atomic_ref(sums_[i][c]).fetch_add(term[c], std::memory_order_relaxed);
    }
    /// Only once all adding has ended.
    const FixedPoint::Value& operator[](std::size_t i) const { return sums_[i]; }
    std::size_t size() const { return sums_.size(); }

  private:
    std::vector<FixedPoint::Value> sums_;
};

}  // namespace interflect
