#include "tests/support/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace interflect::testing_support {

namespace math = boost::math;

double t_test(std::span<const double> samples, double expected, double expected_error) {
    const auto n = static_cast<double>(samples.size());
    const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / n;
    double squares = 0;
    for (const double x : samples) squares += (x - mean) * (x - mean);
    const double error = std::sqrt(squares / (n - 1) / n + expected_error * expected_error);
    if (error == 0) return mean == expected ? 1 : 0;
    return 2 * cdf(math::students_t(n - 1), -std::abs(mean - expected) / error);
}

double z_test(double value, double mean, double standard_deviation) {
    return 2 * cdf(math::normal(), -std::abs(value - mean) / standard_deviation);
}

double binomial_test(std::int64_t successes, std::int64_t trials, double probability) {
    const math::binomial distribution(static_cast<double>(trials), probability);
    const auto k = static_cast<double>(successes);
    const double at_most = cdf(distribution, k), at_least = k > 0 ? cdf(complement(distribution, k - 1)) : 1;
    return std::min(1.0, 2 * std::min(at_most, at_least));
}

double chi_square_test(std::span<const double> observed, std::span<const double> expected, int constraints) {
    double statistic = 0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        const double difference = observed[i] - expected[i];
        statistic += difference * difference / expected[i];
    }
    return cdf(complement(math::chi_squared(static_cast<double>(observed.size()) - constraints), statistic));
}

double bonferroni(std::span<const double> p_values) {
    const double smallest = *std::min_element(p_values.begin(), p_values.end());
    return std::min(1.0, smallest * static_cast<double>(p_values.size()));
}

}  // namespace interflect::testing_support
