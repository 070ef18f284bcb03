#include "tests/validation/report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tests/support/scenes/scenes.h"

namespace interflect::testing_support {

namespace {

/// Probability that a row of a correct program exceeds its tolerance.
constexpr double false_alarm_of_row = 1e-5;

struct Row {
    std::string case_name, quantity;
    double expected = 0, result = 0;
    std::string error, tolerance;
};

std::map<std::string, std::vector<Row>>& tables() {
    static std::map<std::string, std::vector<Row>> all;
    return all;
}

/// Returns the number of standard errors that is exceeded with probability false_alarm_of_row.
double quantile() {
    return boost::math::quantile(boost::math::complement(boost::math::students_t(runs - 1), false_alarm_of_row / 2));
}

std::string text_of(const std::vector<Row>& rows) {
    std::string text =
        "| case | quantity | expected | result | error | tolerance |\n| --- | --- | --: | --: | --: | --: |\n";
    std::string last;
    for (const Row& row : rows) {
        text += fmt::format("| {} | {} | {:.5g} | {:.5g} | {} | {} |\n", row.case_name == last ? "" : row.case_name,
                            row.quantity, row.expected, row.result, row.error, row.tolerance);
        last = row.case_name;
    }
    return text;
}

/// Writes page.md, with its `{{table}}` lines replaced, to the file named by INTERFLECT_VALIDATION_PAGE.
class Page : public testing::Environment {
  public:
    void TearDown() override {
        const char* path = std::getenv("INTERFLECT_VALIDATION_PAGE");
        if (!path) return;
        std::ifstream form(testing_support::repository() / "tests/validation/page.md");
        std::ofstream page(path);
        std::size_t written = 0;
        for (std::string line; std::getline(form, line);) {
            const bool is_table = line.starts_with("{{") && line.ends_with("}}");
            if (!is_table) {
                page << line << '\n';
                continue;
            }
            const auto table = tables().find(line.substr(2, line.size() - 4));
            if (table == tables().end()) throw std::runtime_error("no rows for " + line);
            page << text_of(table->second);
            ++written;
        }
        EXPECT_EQ(written, tables().size()) << "page.md lacks a table";
        EXPECT_TRUE(page.good());
    }
};
const testing::Environment* const page = testing::AddGlobalTestEnvironment(new Page);

}  // namespace

std::vector<Estimate> means_of_runs(std::size_t results,
                                    const std::function<std::vector<double>(std::uint64_t seed)>& run) {
    std::vector<std::vector<double>> found;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) found.push_back(run(seed));
    std::vector<Estimate> estimates(results);
    for (std::size_t i = 0; i < results; ++i) {
        double squares = 0;
        for (const auto& values : found) estimates[i].mean += values.at(i) / runs;
        for (const auto& values : found) squares += std::pow(values[i] - estimates[i].mean, 2);
        estimates[i].standard_error = std::sqrt(squares / (runs - 1) / runs);
    }
    return estimates;
}

Estimate mean_of_runs(const std::function<double(std::uint64_t seed)>& run) {
    return means_of_runs(1, [&](std::uint64_t seed) { return std::vector{run(seed)}; })[0];
}

void check(const std::string& table, const std::string& case_name, const std::string& quantity, double expected,
           const Estimate& result, double bias_bound) {
    const double tolerance = bias_bound * std::abs(expected) + quantile() * result.standard_error;
    EXPECT_NEAR(result.mean, expected, tolerance) << table << ", " << case_name << ", " << quantity;
    // A wider tolerance would not detect a lost factor.
    EXPECT_LT(tolerance, 0.03 * std::abs(expected)) << table << ", " << case_name << ", " << quantity;
    tables()[table].push_back({case_name, quantity, expected, result.mean,
                               fmt::format("{:+.3f}%", 100 * (result.mean - expected) / expected),
                               fmt::format("{:.3f}%", 100 * tolerance / std::abs(expected))});
}

void check_difference(const std::string& table, const std::string& case_name, const std::string& quantity,
                      double expected, double result, double tolerance) {
    EXPECT_NEAR(result, expected, tolerance) << table << ", " << case_name << ", " << quantity;
    tables()[table].push_back({case_name, quantity, expected, result, fmt::format("{:+.3f}", result - expected),
                               fmt::format("{:.3f}", tolerance)});
}

}  // namespace interflect::testing_support
