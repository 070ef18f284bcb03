#pragma once

#include <span>
#include <string>
#include <vector>

#include "interflect/exports/json_text.h"
#include "interflect/solve.h"

namespace interflect::inline detail {

/// How a solution was asked for: the `options` of solution files and of `solve --stats`, under the names of the command
/// line. A limit that was not given is null. Of SolveOptions it lacks the seed and the method's name, which stand
/// beside it, and max_elements, which follows the memory of the machine.
Json json_of(const SolveOptions& options);

/// Sets what json_of() has stored. @throws nlohmann::json::exception, InputError where something is missing or unknown.
void read_options(const Json& stored, SolveOptions& options);

/// Where a run stood after an iteration, but for the time that it took: the same input gives the same text. An error
/// that is not known is null.
Json json_of(const IterationReport& report);

/// What json_of() told. @throws nlohmann::json::exception
IterationReport report_of(const Json& json);

/// The same of every iteration as a table of numbers, for programs that plot it; an error that is not known is
/// infinite.
std::vector<std::string> report_columns();
std::vector<double> report_row(const IterationReport& report);
/// The inverse. @param row  As many numbers as there are columns. @throws std::runtime_error for one that cannot be.
IterationReport report_of_row(std::span<const double> row);

/// A view, with world coordinates in double precision.
Json json_of(const View& view);
View view_of(const Json& json);

/// Three numbers. @throws nlohmann::json::exception
template <class Vector>
Vector vector_of(const Json& json) {
    using Number = decltype(Vector::x);
    return {json.at(0).get<Number>(), json.at(1).get<Number>(), json.at(2).get<Number>()};
}

}  // namespace interflect::inline detail
