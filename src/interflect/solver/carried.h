#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "interflect/base/fixed_point.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/arrivals.h"
#include "interflect/solver/quanta.h"
#include "interflect/solver/ray_allocation.h"
#include "interflect/solver/transport.h"

namespace interflect::inline detail {

/// Payload of one ray of each source of a step. From leaf s: power A_s B_s / (N q_s) and importance A_s rho_s psi_s /
/// (N q_s). From a luminaire part: its power / (N q_s).
class Carried {
  public:
    Carried(const Materials& materials, const ElementForest& forest, const TransportStep& step, double q_sum)
        : materials_(materials),
          forest_(forest),
          step_(step),
          elements_(forest.size()),
          q_sum_over_rays_(q_sum / static_cast<double>(step.rays)) {}

    RgbD power(std::uint32_t source) const { return per_ray(source, radiated(source)); }
    RgbD power(std::uint32_t source, std::size_t group) const {
        if (source < elements_) {
            const Rgb share = step_.groups.of(materials_, forest_, source, group);
            return is_finite(share) ? per_ray(source, RgbD(share)) : RgbD(0);
        }
        return step_.groups.has_part(*step_.emission, source - elements_, group) ? power(source) : RgbD(0);
    }
    double importance(std::uint32_t source) const { return source < elements_ ? importance_of_leaf(source) : 0; }

  private:
    RgbD radiated(std::uint32_t source) const {
        return source < elements_ ? RgbD(step_.light.of(forest_, source)) : step_.emission->power(source - elements_);
    }
    RgbD per_ray(std::uint32_t source, const RgbD& light) const {
        if (!step_.equal_quanta) return light * (source < elements_ ? area_per_ray(source) : per_ray(source));
        const double sum = channel_sum(radiated(source));
        return sum > 0 ? light / sum : RgbD(0);
    }
    double importance_of_leaf(std::uint32_t leaf) const {
        return materials_.mean_reflectance(forest_.patch(leaf), leaf) * step_.importance[leaf] * area_per_ray(leaf);
    }
    double per_ray(std::uint32_t source) const { return q_sum_over_rays_ / step_.q[source]; }
    double area_per_ray(std::uint32_t leaf) const { return forest_.area(leaf) * per_ray(leaf); }

    const Materials& materials_;
    const ElementForest& forest_;
    const TransportStep& step_;
    std::uint32_t elements_;  // size of the forest at the start of the step
    double q_sum_over_rays_;
};

/// Sums over all rays of a step.
struct Totals {
    RgbD power{0, 0, 0};  ///< [lm or W]
    double square = 0;    ///< Squared luminance of each ray's power.
    double importance = 0;
    double importance_square = 0;  ///< Squared importance of each ray.
    Quanta quanta;

    Totals& operator+=(const Totals& other) {
        power += other.power;
        square += other.square;
        importance += other.importance;
        importance_square += other.importance_square;
        quanta += other.quanta;
        return *this;
    }
};
Totals all_carried(const TransportStep& step, const RayAllocation& allocation, const Carried& carried);

/// Fixed-point units of contributions. The sum over all rays fits.
struct Units {
    FixedPoint power, square, importance;

    /// @param visits  Upper bound of the number of elements that receive the same power by reflection; >= 1.
    Units(const Totals& all, double visits)
        : power(channel_sum(all.power) * visits), square(all.square * visits), importance(all.importance) {}

    Arrivals::Contribution contribution_of(const RgbD& particle) const {
        Arrivals::Contribution contribution{};
        const FixedPoint::Value of_power = power.from(particle);
        std::copy(of_power.begin(), of_power.end(), contribution.begin());
        contribution[3] = square.from(std::pow(luminance(particle), 2));
        return contribution;
    }

    /// @param transmittance  Product over the panes that the ray has passed.
    Arrivals::Contribution contribution(const TransportStep& step, const Carried& carried, std::uint32_t source,
                                        const Rgb& transmittance = Rgb(1)) const {
        Arrivals::Contribution contribution{};
        if (step.carries_power()) contribution = contribution_of(carried.power(source) * RgbD(transmittance));
        if (step.carries_importance())
            contribution[Arrivals::importance_term] =
                importance.from(carried.importance(source) * channel_sum(transmittance) / 3);
        return contribution;
    }

    /// Replaces `terms` by the power of each light group in the contribution.
    void add_groups(const TransportStep& step, const Carried& carried, std::uint32_t source,
                    std::vector<std::int64_t>& terms, const Rgb& transmittance = Rgb(1)) const {
        terms.clear();
        for (std::size_t g = 0; g < step.groups.size(); ++g) {
            const FixedPoint::Value of_group = power.from(carried.power(source, g) * RgbD(transmittance));
            terms.insert(terms.end(), of_group.begin(), of_group.end());
        }
    }
};

}  // namespace interflect::inline detail
