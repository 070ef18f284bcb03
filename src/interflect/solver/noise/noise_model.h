#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "interflect/base/files/state_archive.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/solver/noise/estimate.h"
#include "interflect/solver/noise/history.h"

namespace interflect::detail {

/// Noise of the mean irradiance: the variance of independent rays, times a factor from differences between iterations
/// (docs/method/method.md, Errors).
class NoiseModel {
  public:
    explicit NoiseModel(std::size_t elements) : per_ray_(elements, 0.0f) { scale_.fill(1); }

    /// Returns the luminance variance after `rays` rays: of the mean of a root, or of the difference of another element
    /// from its parent.
    float variance(const ElementForest& forest, std::span<const Rgb> mean, ElementIndex e, float rays) const {
        return scale_[hit_rate_class(forest, mean, e)] * independent_variance(forest, e) / rays;
    }
    /// Returns the variance of a part of the mean. @param independent  Variance of this part for independent rays.
    float variance_of_part(const ElementForest& forest, std::span<const Rgb> mean, ElementIndex e,
                           float independent) const {
        return scale_[hit_rate_class(forest, mean, e)] * share_of_own(forest, e) * independent;
    }
    bool is_known() const { return iterations_ > 1; }

    /// Returns the noise variance of each sibling `first` ... `first` + 3, relative to the mean variance of the four.
    /// With few rays, the shares tend to 1, because a sibling may be dark by chance.
    std::array<float, 4> shares(const ElementForest& forest, std::span<const Rgb> mean, ElementIndex first,
                                float rays) const;

    /// Adds new elements. Their variance per ray is four times that of the parent, because a child receives a quarter
    /// of the rays on a quarter of the area.
    void grow(const ElementForest& forest, std::uint32_t first);

    /// Adds the differences between an iteration and the mean. Call before the iteration is merged.
    /// @param history  Number of rays in the mean of each element; 0: its difference from the parent is unknown.
    /// @param weight   Weight of the squared error of an element; inner elements have the sum of their leaves.
    void add(const ElementForest& forest, const Estimate& fresh, std::span<const Rgb> mean, const History& history,
             float rays, const std::function<double(ElementIndex)>& weight);

    /// Sets the variance per ray from a mean with known variance, for the elements from `first` on.
    /// @param history  Number of rays in the mean of each element.
    void set_variance(std::span<const float> variance, const History& history, std::uint32_t first = 0) {
        for (std::size_t e = first; e < per_ray_.size(); ++e) per_ray_[e] = history[e] * variance[e];
    }

    void shrink(std::size_t size) { per_ray_.resize(size); }

    void scale_by_patch(const ElementForest& forest, std::span<const float> factor) {
        for (ElementIndex e{0}; e < per_ray_.size(); ++e) per_ray_[e] *= factor[forest.patch(e)];
    }
    std::size_t elements() const { return per_ray_.size(); }
    void archive(StateArchive& archive) {
        archive.amounts("noise/per_ray", per_ray_);
        archive.amounts("noise/scale", scale_);
        archive.amounts("noise/observed", spread_.observed);
        archive.amounts("noise/independent", spread_.independent);
        archive("noise/iterations", iterations_);
    }

  private:
    static constexpr std::size_t hit_rate_classes = 48;

    /// Squared differences between iterations by class: observed, and expected for independent rays.
    struct Spread {
        std::array<double, hit_rate_classes> observed{}, independent{};
        Spread& operator+=(const Spread& other);
    };

    /// Returns the class n of an element: about one in 2^n rays hits it. Siblings share a class, because a single
    /// sibling may be hit by chance.
    std::size_t hit_rate_class(const ElementForest& forest, std::span<const Rgb> mean, ElementIndex e) const {
        const ElementIndex parent = forest.parent(e), known = parent == none ? e : parent;
        const float h = luminance(mean[known]), rays_per_contribution = per_ray_[known] / (h * h);
        if (!(rays_per_contribution < 0x1p45f)) return hit_rate_classes - 1;
        const int n = rays_per_contribution > 1 ? std::ilogb(rays_per_contribution) : 0;
        return static_cast<std::size_t>(n) + (parent == none ? 0 : 2);
    }
    /// Returns the variance of an element's difference from its parent, relative to its own variance. For four
    /// independent siblings it is 3/4.
    static float share_of_own(const ElementForest& forest, ElementIndex e) {
        return e < forest.patch_count() ? 1.0f : 0.75f;
    }
    float independent_variance(const ElementForest& forest, ElementIndex e) const {
        return share_of_own(forest, e) * per_ray_[e];
    }

    std::vector<float> per_ray_;  // variance of the irradiance for one ray, by element [irradiance^2]
    std::array<float, hit_rate_classes> scale_;
    Spread spread_;  // earlier iterations have exponentially decreasing weights
    int iterations_ = 0;
};

}  // namespace interflect::detail
