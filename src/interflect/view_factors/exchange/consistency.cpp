#include <algorithm>
#include <cmath>

#include "interflect/view_factors.h"
#include "interflect/view_factors/exchange/transposed.h"

namespace interflect {

using namespace detail;

namespace {

class DeviationSum {
  public:
    void add(double deviation, double error) {
        add(std::abs(deviation), largest_, squares_);
        add(std::abs(deviation) / error, largest_in_errors_, squares_in_errors_);
        ++count_;
    }
    Deviation result() const {
        const double count = std::max(count_, 1.0);
        return {largest_, std::sqrt(squares_ / count), largest_in_errors_, std::sqrt(squares_in_errors_ / count)};
    }

  private:
    static void add(double value, double& largest, double& squares) {
        largest = std::max(largest, value);
        squares += value * value;
    }
    double largest_ = 0, squares_ = 0, largest_in_errors_ = 0, squares_in_errors_ = 0, count_ = 0;
};

Deviation closure_deviation(const ViewFactors& f) {
    DeviationSum sum;
    const auto squared = [](float error) { return double{error} * double{error}; };
    for (std::size_t i = 0; i < f.size(); ++i) {
        if (!(f.areas[i] > 0)) continue;
        double variance = squared(f.sky_errors[i]) + squared(f.ground_errors[i]) + squared(f.blocked_errors[i]);
        for (auto e = static_cast<std::size_t>(f.row_offsets[i]); e < static_cast<std::size_t>(f.row_offsets[i + 1]);
             ++e)
            variance += squared(f.errors[e]);
        sum.add(f.closure(i) - 1, std::sqrt(variance));
    }
    return sum.result();
}

Deviation reciprocity_deviation(const ViewFactors& f) {
    DeviationSum sum;
    Transposed transposed(f);
    for (std::size_t i = 0; i < f.size(); ++i)
        for (auto e = static_cast<std::size_t>(f.row_offsets[i]); e < static_cast<std::size_t>(f.row_offsets[i + 1]);
             ++e) {
            const auto j = static_cast<std::size_t>(f.columns[e]);
            const std::int64_t back = transposed.find(i, j);
            const bool is_first_of_pair = back == Transposed::absent ? j != i : i < j;
            if (!is_first_of_pair || !(std::min(f.areas[i], f.areas[j]) > 0)) continue;
            const bool has_back = back != Transposed::absent;
            const double x_ij = f.areas[i] * f.values[e], error_ij = f.areas[i] * f.errors[e];
            const double x_ji = has_back ? f.areas[j] * f.values[static_cast<std::size_t>(back)] : 0;
            const double error_ji =
                f.areas[j] * (has_back ? double{f.errors[static_cast<std::size_t>(back)]} : f.smallest_error());
            const double scale = std::min(f.areas[i], f.areas[j]);
            sum.add((x_ij - x_ji) / scale, std::hypot(error_ij, error_ji) / scale);
        }
    return sum.result();
}

}  // namespace

Consistency consistency(const ViewFactors& factors) {
    return {closure_deviation(factors), reciprocity_deviation(factors)};
}

}  // namespace interflect
