#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace interflect::testing_support {

/// Runs of a random result, with seeds 1, 2, ...
inline constexpr int runs = 16;

struct Estimate {
    double mean = 0, standard_error = 0;
};
Estimate mean_of_runs(const std::function<double(std::uint64_t seed)>& run);
/// Computes the same for several results per run, [run][result].
std::vector<Estimate> means_of_runs(std::size_t results,
                                    const std::function<std::vector<double>(std::uint64_t seed)>& run);

/// Compares a result with its expected value, and enters both in a table of docs/method/validation.md. The tolerance is
/// the bias bound plus a multiple of the standard error that correct code exceeds with a probability of 1e-5 (Student's
/// t with runs - 1 degrees of freedom). The test fails beyond it.
/// @param table        Name of the table, as in page.md.
/// @param case_name    Name of the case; rows of a table with the same name are one case.
/// @param quantity     Quantity and unit.
/// @param bias_bound   Of the result, relative to `expected`: rounding, a polygon in place of a disc, unshot light.
void check(const std::string& table, const std::string& case_name, const std::string& quantity, double expected,
           const Estimate& result, double bias_bound);

/// Checks the same for a deterministic result and an absolute tolerance [unit of the quantity].
void check_difference(const std::string& table, const std::string& case_name, const std::string& quantity,
                      double expected, double result, double tolerance);

}  // namespace interflect::testing_support
