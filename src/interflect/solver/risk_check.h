#pragma once

#include <algorithm>

namespace interflect {

/// Squared errors of reduced differences: what Detail::risk() expected, and what later iterations told.
struct RiskCheck {
    double expected = 0, measured = 0;

    RiskCheck& operator+=(const RiskCheck& o) {
        expected += o.expected, measured += o.measured;
        return *this;
    }
    /// Enters one iteration's; earlier ones count half as much with each.
    void add(const RiskCheck& fresh) {
        expected = expected / 2 + fresh.expected;
        measured = measured / 2 + fresh.measured;
    }
    /// What expected errors are to be multiplied by; 1 where nothing is known.
    double factor() const { return expected > 0 ? std::clamp(measured / expected, 0.1, 10.0) : 1; }
};

}  // namespace interflect
