#pragma once

#include <span>
#include <string>
#include <vector>

#include "interflect/exports/records/json_text.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Returns the options, named as on the command line. Unset limits are null. Omits seed, method and max_elements.
Json json_of(const SolveOptions& options);

/// Inverse of json_of(). @throws Json::exception, std::runtime_error or InputError for missing or unknown values, and
/// for numbers out of range.
/// @param may_be_negative  Whether the caller checks the sign of real numbers.
void read_options(const Json& stored, SolveOptions& options, bool may_be_negative = false);

/// Returns a report without its duration, so equal input gives equal text. Unknown errors are null.
Json json_of(const IterationReport& report);

/// Inverse of json_of(), also for former names of numbers. @throws Json::exception
IterationReport report_of(const Json& stored);

/// Returns the names of the columns of report_row().
std::vector<std::string> report_columns();
/// Replaces former names of columns.
std::vector<std::string> with_present_columns(std::vector<std::string> columns);
/// Returns the numbers of a report. Unknown errors are infinite.
std::vector<double> report_row(const IterationReport& report);
/// Inverse of report_row(). @throws std::runtime_error for impossible numbers.
IterationReport report_of_row(std::span<const double> row);

Json json_of(const View& view);
View view_of(const Json& json);

/// @throws Json::exception
template <class Vector>
Vector vector_of(const Json& json) {
    using Number = decltype(Vector::x);
    return {json.at(0).get<Number>(), json.at(1).get<Number>(), json.at(2).get<Number>()};
}

}  // namespace interflect::detail
