#pragma once

#include <algorithm>

namespace interflect::inline detail {

/// Squared errors of reduced differences: what Detail::risk() expected, and what later iterations told.
struct RiskCheck {
    double expected = 0, measured = 0;

    RiskCheck& operator+=(const RiskCheck& o) {
        expected += o.expected, measured += o.measured;
        return *this;
    }
    /// Enters one iteration's; earlier ones count half as much with each.
    /// @param weight  In [0, 1]: less for iterations that are too short to tell much.
    void add(const RiskCheck& fresh, double weight) {
        expected = expected * (1 - weight / 2) + weight * fresh.expected;
        measured = measured * (1 - weight / 2) + weight * fresh.measured;
    }
    /// What expected errors are to be multiplied by; 1 where nothing is known.
    double factor() const { return expected > 0 ? std::clamp(measured / expected, 0.1, 10.0) : 1; }
};

}  // namespace interflect::inline detail
