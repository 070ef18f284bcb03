#include "interflect/solver/noise/noise_model.h"

#include <algorithm>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Factor by which the weight of earlier spreads decreases in each iteration, because mesh and sampling change.
constexpr double spread_decay = 0.75;

/// Limit of a factor of the noise, and of its inverse.
constexpr double largest_scale = 100;

/// Number of contributions at which the measured shares have weight 1/2.
constexpr float contributions_of_half_weight = 16;

}  // namespace

NoiseModel::Spread& NoiseModel::Spread::operator+=(const Spread& other) {
    for (std::size_t n = 0; n < hit_rate_classes; ++n) {
        observed[n] += other.observed[n];
        independent[n] += other.independent[n];
    }
    return *this;
}

void NoiseModel::grow(const ElementForest& forest, std::uint32_t first) {
    inherit(forest, first, per_ray_);
    for (ElementIndex e(first); e < forest.size(); ++e) per_ray_[e] = 4 * per_ray_[forest.parent(e)];
}

std::array<float, 4> NoiseModel::shares(const ElementForest& forest, std::span<const Rgb> mean, ElementIndex first,
                                        float rays) const {
    float variance = 0, area = 0;
    for (ElementIndex e = first; e < first + 4; ++e) {
        variance += forest.area(e) * per_ray_[e];
        area += forest.area(e);
    }
    std::array<float, 4> shares{1, 1, 1, 1};
    if (!(variance > 0) || !(rays > 0)) return shares;
    variance /= area;
    const float h = luminance(mean[forest.parent(first)]);
    const float contributions = 4 * rays * h * h / variance,
                weight_of_measured = contributions / (contributions + contributions_of_half_weight);
    for (std::uint32_t k = 0; k < 4; ++k)
        shares[k] = weight_of_measured * per_ray_[first + k] / variance + (1 - weight_of_measured);
    return shares;
}

void NoiseModel::add(const ElementForest& forest, const Estimate& fresh, std::span<const Rgb> mean,
                     const History& history, float rays, const std::function<double(ElementIndex)>& weight) {
    // Compare the differences between the iteration and the mean with the noise of independent rays
    const Spread spread =
        parallel_sum(forest.size(), elements_per_task, Spread(), [&](std::size_t begin, std::size_t end) {
            Spread sum;
            for (ElementIndex e(begin); e < end; ++e) {
                const float m = history[e];
                if (!(m > 0)) continue;
                const double w = weight(e);
                if (w == 0) continue;
                float difference = luminance(fresh.irradiance[e]) - luminance(mean[e]);
                if (const ElementIndex parent = forest.parent(e); parent != none)
                    difference -= luminance(fresh.irradiance[parent]) - luminance(mean[parent]);
                const std::size_t n = hit_rate_class(forest, mean, e);
                const float shared = fresh.shared_variance.empty() ? 0 : m * fresh.shared_variance[e],
                            independent = (rays * std::max(0.0f, per_ray_[e] - shared) + m * rays * fresh.variance[e]) /
                                          (rays + m);
                sum.observed[n] += w * static_cast<double>(difference) * difference * (rays * m / (rays + m));
                sum.independent[n] += w * static_cast<double>(share_of_own(forest, e) * independent);
            }
            return sum;
        });

    // Average the variance per ray
    parallel_for_ranges(forest.size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            const float share = iterations_ == 0 ? 1 : rays / (rays + std::max(history[e], rays));
            per_ray_[e] += share * (rays * fresh.variance[e] - per_ray_[e]);
        }
    });
    ++iterations_;
    if (!is_known()) return;

    // Update the factor of each class of hit rates
    for (std::size_t n = 0; n < hit_rate_classes; ++n) {
        spread_.observed[n] = spread_decay * spread_.observed[n] + spread.observed[n];
        spread_.independent[n] = spread_decay * spread_.independent[n] + spread.independent[n];
        if (!(spread_.independent[n] > 0)) continue;
        const double scale = spread_.observed[n] / spread_.independent[n];
        scale_[n] = static_cast<float>(std::clamp(scale, 1 / largest_scale, largest_scale));
    }
}

}  // namespace interflect::detail
