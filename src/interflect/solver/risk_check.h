#pragma once

#include <algorithm>

namespace interflect::inline detail {

/// Squared errors after shrinkage: expected by Detail::risk(), and measured by later iterations.
struct RiskCheck {
    double expected = 0, measured = 0;

    RiskCheck& operator+=(const RiskCheck& o) {
        expected += o.expected, measured += o.measured;
        return *this;
    }
    /// Adds an iteration; earlier ones decay by 1 - weight / 2. @param weight  In [0, 1]; less for short iterations.
    void add(const RiskCheck& fresh, double weight) {
        expected = expected * (1 - weight / 2) + weight * fresh.expected;
        measured = measured * (1 - weight / 2) + weight * fresh.measured;
    }
    /// Factor that corrects expected errors; 1 without data.
    double factor() const { return expected > 0 ? std::clamp(measured / expected, 0.1, 10.0) : 1; }
};

}  // namespace interflect::inline detail
