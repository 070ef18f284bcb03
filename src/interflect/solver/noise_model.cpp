#include "interflect/solver/noise_model.h"

#include <algorithm>

#include "interflect/base/parallel.h"

namespace interflect {

namespace {

/// What is known from earlier iterations counts so much less with each: mesh and sampling weights change.
constexpr double memory = 0.75;
/// A level's scale is taken to lie within this factor of 1.
constexpr double largest_scale = 100;

}  // namespace

NoiseModel::Spread& NoiseModel::Spread::operator+=(const Spread& other) {
    for (std::size_t l = 0; l < levels; ++l) {
        observed[l] += other.observed[l];
        independent[l] += other.independent[l];
    }
    return *this;
}

void NoiseModel::grow(const ElementForest& forest, std::uint32_t first) {
    inherit(forest, first, per_ray_);
    for (std::uint32_t e = first; e < forest.size(); ++e) per_ray_[e] = 4 * per_ray_[forest.parent(e)];
}

void NoiseModel::add(const ElementForest& forest, const FreshEstimate& fresh, std::span<const Rgb> mean,
                     std::span<const float> history, float rays, const std::function<double(std::uint32_t)>& weight) {
    const Spread spread =
        parallel_sum(forest.size(), elements_at_once, Spread(), [&](std::size_t begin, std::size_t end) {
            Spread sum;
            for (auto e = static_cast<std::uint32_t>(begin); e < end; ++e) {
                const float m = history[e];
                per_ray_[e] += rays / (rays + std::max(m, rays)) * (rays * fresh.variance[e] - per_ray_[e]);
                if (iterations_ == 0) per_ray_[e] = rays * fresh.variance[e];
                if (!(m > 0)) continue;
                float difference = luminance(fresh.irradiance[e]) - luminance(mean[e]);
                if (const std::uint32_t parent = forest.parent(e); parent != none)
                    difference -= luminance(fresh.irradiance[parent]) - luminance(mean[parent]);
                const double w = weight(e);
                const auto level = static_cast<std::size_t>(forest.level(e));
                sum.observed[level] += w * static_cast<double>(difference) * difference * (rays * m / (rays + m));
                sum.independent[level] += w * static_cast<double>(independent_variance(forest, e));
            }
            return sum;
        });
    ++iterations_;
    if (!is_known()) return;
    for (std::size_t l = 0; l < levels; ++l) {
        spread_.observed[l] = memory * spread_.observed[l] + spread.observed[l];
        spread_.independent[l] = memory * spread_.independent[l] + spread.independent[l];
        if (!(spread_.independent[l] > 0)) continue;
        const double scale = spread_.observed[l] / spread_.independent[l];
        scale_[l] = static_cast<float>(std::clamp(scale, 1 / largest_scale, largest_scale));
    }
}

}  // namespace interflect
