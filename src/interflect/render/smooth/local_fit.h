#pragma once

#include <algorithm>

#include "interflect/core.h"

namespace interflect::detail {

/// Weighted least-squares fit of a linear function to values around the origin of a plane.
class LocalFit {
  public:
    /// Adds a value at (s, t) with weight w. @param variance  Variance of the mean channel of the value.
    void add(float w, float s, float t, const Rgb& value, float variance = 0) {
        for (int c = 0; c < 3; ++c) {
            least_[c] = weight_ > 0 ? std::min(least_[c], value[c]) : value[c];
            most_[c] = weight_ > 0 ? std::max(most_[c], value[c]) : value[c];
        }
        const float ws = w * s, wt = w * t;
        weight_ += w;
        s_ += ws;
        t_ += wt;
        ss_ += ws * s;
        st_ += ws * t;
        tt_ += wt * t;
        sum_ += w * value;
        sum_s_ += ws * value;
        sum_t_ += wt * value;
        variance_ += w * w * variance;
        variance_s_ += w * ws * variance;
        variance_t_ += w * wt * variance;
        variance_ss_ += ws * ws * variance;
        variance_st_ += ws * wt * variance;
        variance_tt_ += wt * wt * variance;
    }
    float weight() const { return weight_; }

    /// The fit's value at the origin is the sum over the values of w (constant + by_s s + by_t t) value.
    struct Coefficients {
        float constant, by_s, by_t;
    };
    Coefficients coefficients() const {
        // The ridge bounds the slope if there are few or nearly collinear points.
        constexpr float ridge_share = 0.1f;
        const float ridge = ridge_share * (ss_ + tt_), a = ss_ + ridge, d = tt_ + ridge;
        const float determinant = a * d - st_ * st_;
        const float s = determinant > 0 ? (s_ * d - t_ * st_) / determinant : 0;
        const float t = determinant > 0 ? (t_ * a - s_ * st_) / determinant : 0;
        // Schur complement of the slopes: the weight of the constant
        const float remaining = weight_ - s_ * s - t_ * t;
        if (!(remaining > 0)) return {1 / weight_, 0, 0};
        return {1 / remaining, -s / remaining, -t / remaining};
    }
    /// Returns the value at the origin, within the range of the values.
    Rgb value() const {
        const Coefficients k = coefficients();
        Rgb fitted = sum_ * k.constant + sum_s_ * k.by_s + sum_t_ * k.by_t;
        for (int c = 0; c < 3; ++c) fitted[c] = std::clamp(fitted[c], least_[c], most_[c]);
        return fitted;
    }
    /// Returns the variance of the mean channel of value(), for independent values.
    float variance() const {
        const Coefficients k = coefficients();
        return k.constant * k.constant * variance_ + k.by_s * k.by_s * variance_ss_ + k.by_t * k.by_t * variance_tt_ +
               2 * (k.constant * (k.by_s * variance_s_ + k.by_t * variance_t_) + k.by_s * k.by_t * variance_st_);
    }

  private:
    float weight_ = 0, s_ = 0, t_ = 0, ss_ = 0, st_ = 0, tt_ = 0;  // weighted sums
    Rgb sum_{0, 0, 0}, sum_s_{0, 0, 0}, sum_t_{0, 0, 0};
    Rgb least_{0, 0, 0}, most_{0, 0, 0};
    // Sums of w^2 times the variance, also multiplied by the coordinates in the name.
    float variance_ = 0, variance_s_ = 0, variance_t_ = 0, variance_ss_ = 0, variance_st_ = 0, variance_tt_ = 0;
};

}  // namespace interflect::detail
