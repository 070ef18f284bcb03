#pragma once

#include <cstdint>
#include <span>

namespace interflect::testing_support {

/// Probability that correct code fails one test; seeds are fixed, so a test always passes or always fails.
inline constexpr double false_alarm = 1e-3;

/// Returns the two-sided p-value of Student's t test of the hypothesis that the samples' population has the mean
/// `expected`.
/// @param samples         At least two independent values. If all are equal, p is 1 for values of `expected`, else 0.
/// @param expected_error  Standard error of `expected` if it is an independent estimate itself.
double t_test(std::span<const double> samples, double expected, double expected_error = 0);

/// Returns the two-sided p-value of the hypothesis that `value` is normal with this mean and standard deviation.
double z_test(double value, double mean, double standard_deviation);

/// Returns the two-sided p-value of the hypothesis that each of `trials` independent trials succeeds with
/// `probability`.
double binomial_test(std::int64_t successes, std::int64_t trials, double probability);

/// Returns the p-value of Pearson's chi-square test; every expected count should be 5 or more.
/// @param constraints  Number of independent sums of the observed counts to which the expected counts were fitted.
double chi_square_test(std::span<const double> observed, std::span<const double> expected, int constraints = 1);

/// Returns the p-value of all hypotheses together, by Bonferroni's bound, which also holds for dependent tests.
double bonferroni(std::span<const double> p_values);

}  // namespace interflect::testing_support
