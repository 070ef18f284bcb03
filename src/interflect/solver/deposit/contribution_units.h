#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "interflect/base/numbers/fixed_point.h"
#include "interflect/solver/deposit/contributions.h"
#include "interflect/solver/sampling/payload.h"

namespace interflect::detail {

/// Fixed-point units of contributions. The sums over all rays do not overflow.
struct ContributionUnits {
    FixedPoint power, square, importance;

    /// @param max_deposits  Upper bound of the number of elements on which the same power is deposited by reflections;
    /// >= 1.
    ContributionUnits(const PayloadTotals& all, double max_deposits)
        : power(channel_sum(all.power) * max_deposits), square(all.square * max_deposits), importance(all.importance) {}

    /// Returns the contribution of a particle with this power, without importance.
    Contribution contribution_of(const RgbD& particle) const {
        Contribution contribution{};
        const FixedPoint::Value of_power = power.from(particle);
        std::copy(of_power.begin(), of_power.end(), contribution.begin());
        contribution[3] = square.from(std::pow(luminance(particle), 2));
        return contribution;
    }

    Contribution contribution(const RayPlan& plan, const Payload& payload, std::uint32_t source,
                              const Rgb& transmittance = Rgb(1)) const {
        Contribution contribution{};
        if (plan.carries_power()) contribution = contribution_of(payload.power(source) * RgbD(transmittance));
        if (plan.carries_importance())
            contribution[importance_term] =
                importance.from(payload.importance(source) * channel_sum(transmittance) / 3);
        return contribution;
    }

    void fill_groups(const RayPlan& plan, const Payload& payload, std::uint32_t source,
                     std::vector<std::int64_t>& terms, const Rgb& transmittance = Rgb(1)) const {
        terms.clear();
        for (std::size_t g = 0; g < plan.groups.size(); ++g) {
            const FixedPoint::Value of_group = power.from(payload.power(source, g) * RgbD(transmittance));
            terms.insert(terms.end(), of_group.begin(), of_group.end());
        }
    }
};

}  // namespace interflect::detail
