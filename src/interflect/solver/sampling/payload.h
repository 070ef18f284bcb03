#pragma once

#include <cstdint>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/sampling/ray_allocation.h"
#include "interflect/solver/sampling/ray_plan.h"

namespace interflect::detail {

/// Payload of one ray. From leaf s: power A_s B_s / (N q_s) and importance A_s rho_s psi_s / (N q_s). From a luminaire
/// part: its power / (N q_s).
class Payload {
  public:
    Payload(const Materials& materials, const ElementForest& forest, const RayPlan& plan, double q_sum)
        : materials_(materials),
          forest_(forest),
          plan_(plan),
          elements_(forest.size()),
          q_sum_over_rays_(q_sum / static_cast<double>(plan.rays)) {}

    RgbD power(std::uint32_t source) const { return per_ray(source, radiated(source)); }
    RgbD power(std::uint32_t source, std::size_t group) const {
        if (source < elements_) {
            const Rgb share = plan_.groups.of(materials_, forest_, ElementIndex(source), group);
            return is_finite(share) ? per_ray(source, RgbD(share)) : RgbD(0);
        }
        return plan_.groups.has_part(*plan_.emission, source - elements_, group) ? power(source) : RgbD(0);
    }
    double importance(std::uint32_t source) const {
        return source < elements_ ? importance_of_leaf(ElementIndex(source)) : 0;
    }

  private:
    RgbD radiated(std::uint32_t source) const {
        return source < elements_ ? RgbD(plan_.light.of(forest_, ElementIndex(source)))
                                  : plan_.emission->power(source - elements_);
    }
    RgbD per_ray(std::uint32_t source, const RgbD& light) const {
        if (!plan_.equal_payloads)
            return light * (source < elements_ ? area_per_ray(ElementIndex(source)) : per_ray(source));
        const double sum = channel_sum(radiated(source));
        return sum > 0 ? light / sum : RgbD(0);
    }
    double importance_of_leaf(ElementIndex leaf) const {
        return materials_.mean_reflectance(forest_.patch(leaf), leaf) * plan_.importance[leaf] * area_per_ray(leaf);
    }
    double per_ray(std::uint32_t source) const { return q_sum_over_rays_ / plan_.q[source]; }
    double area_per_ray(ElementIndex leaf) const { return forest_.area(leaf) * per_ray(leaf); }

    const Materials& materials_;
    const ElementForest& forest_;
    const RayPlan& plan_;
    std::uint32_t elements_;  // number of elements before the step
    double q_sum_over_rays_;
};

/// Histogram of ray power, in bins of a quarter of an octave.
class PayloadHistogram {
  public:
    /// @param power  Sum of the channels [lm or W].
    void add(double power, std::int64_t rays);
    PayloadHistogram& operator+=(const PayloadHistogram& other);

    /// Returns the largest power of a ray, relative to the mean; 1 without power.
    double largest_over_mean() const;
    /// Returns the power that a share of the rays exceeds, relative to the mean; accurate to 19%.
    double quantile_over_mean(double share) const;

    void archive(StateArchive& archive) {
        archive("payloads/rays", rays_);
        StateArchive::require_range(rays_.empty() || rays_.size() == bins, "payloads/rays");
        archive.amounts("payloads/power", power_);
        archive.amounts("payloads/largest", largest_);
        archive("payloads/count", count_);
    }

  private:
    static constexpr int bins_per_octave = 4, middle_bin = 512, bins = 2 * middle_bin;
    std::vector<std::int64_t> rays_;
    double power_ = 0, largest_ = 0;
    std::int64_t count_ = 0;
};

struct PayloadTotals {
    RgbD power{0, 0, 0};  ///< [lm or W]
    double square = 0;    ///< Sum of the squared luminance of power.
    double importance = 0;
    double importance_square = 0;
    PayloadHistogram histogram;

    PayloadTotals& operator+=(const PayloadTotals& other) {
        power += other.power;
        square += other.square;
        importance += other.importance;
        importance_square += other.importance_square;
        histogram += other.histogram;
        return *this;
    }
};
PayloadTotals total_payload(const RayPlan& plan, const RayAllocation& allocation, const Payload& payload);

}  // namespace interflect::detail
