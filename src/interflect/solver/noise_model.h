#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "interflect/colour.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/group_light.h"
#include "interflect/solver/state_archive.h"

namespace interflect::inline detail {

/// An estimate of irradiance that an iteration made, before it is merged.
struct FreshEstimate {
    std::vector<Rgb> irradiance;  ///< H of every element [lm/m^2 or W/m^2].
    std::vector<float> variance;  ///< Of its luminance, if rays arrived independently of each other.
    GroupLight groups = {};       ///< Of H what each light group brought.
};

/// How noisy the running mean of irradiance is. Of every element it keeps the variance that one ray would cause if rays
/// arrived independently: that is known from few rays. How much less it is thanks to low-discrepancy points, or more
/// since noise is reflected on, is told by how much independent iterations differ, for all elements together that about
/// as many rays meet: points are the better distributed the more there are of them, and no element that a single heavy
/// ray met counts for those that thousands do.
class NoiseModel {
  public:
    explicit NoiseModel(std::size_t elements) : per_ray_(elements, 0.0f) { scale_.fill(1); }

    /// Variance of the luminance of an element's irradiance where that is the mean of so many rays: of a root; of
    /// others, of their difference from their parent. @param mean  The running mean, of every element.
    float variance(const ElementForest& forest, std::span<const Rgb> mean, std::uint32_t e, float rays) const {
        return scale_[rarity(forest, mean, e)] * independent_variance(forest, e) / rays;
    }
    /// Whether two iterations have been compared.
    bool is_known() const { return iterations_ > 1; }

    /// Gives elements from `first` on, made since, a quarter of their parents' rays on a quarter of the area.
    void grow(const ElementForest& forest, std::uint32_t first);

    /// Enters an iteration of so many rays, before it is merged.
    /// @param mean     The running mean.
    /// @param history  Rays that it stands for, by element; 0: nothing is known of how the element differs from its
    ///                 parent.
    /// @param weight   How much a leaf's squared error counts; inner elements count as their leaves together.
    void add(const ElementForest& forest, const FreshEstimate& fresh, std::span<const Rgb> mean,
             std::span<const float> history, float rays, const std::function<double(std::uint32_t)>& weight);

    /// From now on one ray causes so many times the variance, by patch.
    void scale_by_patch(const ElementForest& forest, std::span<const float> factor) {
        for (std::uint32_t e = 0; e < per_ray_.size(); ++e) per_ray_[e] *= factor[forest.patch(e)];
    }
    std::size_t elements() const { return per_ray_.size(); }
    void archive(StateArchive& archive) {
        archive("noise/per_ray", per_ray_);
        archive("noise/scale", scale_);
        archive("noise/observed", spread_.observed);
        archive("noise/independent", spread_.independent);
        archive("noise/iterations", iterations_);
    }

  private:
    static constexpr std::size_t rarities = 48;
    /// Squares of differences between an iteration and the mean, summed over the elements of each rarity.
    struct Spread {
        std::array<double, rarities> observed{}, independent{};
        Spread& operator+=(const Spread& other);
    };

    /// How few of all rays meet an element: one in about 2^n. Siblings, of which one was met by luck, have the same n.
    std::size_t rarity(const ElementForest& forest, std::span<const Rgb> mean, std::uint32_t e) const {
        const std::uint32_t parent = forest.parent(e), known = parent == none ? e : parent;
        const float h = luminance(mean[known]), rays_per_arrival = per_ray_[known] / (h * h);
        if (!(rays_per_arrival < 0x1p45f)) return rarities - 1;
        const int n = rays_per_arrival > 1 ? std::ilogb(rays_per_arrival) : 0;
        return static_cast<std::size_t>(n) + (parent == none ? 0 : 2);
    }
    /// Of siblings' independent variance three quarters are left of that of their differences from their mean.
    static float share_of_own(const ElementForest& forest, std::uint32_t e) {
        return e < forest.patch_count() ? 1.0f : 0.75f;
    }
    float independent_variance(const ElementForest& forest, std::uint32_t e) const {
        return share_of_own(forest, e) * per_ray_[e];
    }

    std::vector<float> per_ray_;  // [irradiance^2]
    std::array<float, rarities> scale_;
    Spread spread_;  // of all iterations, later ones counting more
    int iterations_ = 0;
};

}  // namespace interflect::inline detail
