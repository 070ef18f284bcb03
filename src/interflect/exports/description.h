#pragma once

#include <string>
#include <string_view>

#include "interflect/solution_file.h"

namespace interflect::inline detail {

/// What a solution file holds besides long arrays, as JSON text: docs/solution-file.md lists its keys.
/// @throws std::runtime_error where a number is not finite.
std::string describe(const Scene& scene, const Solution& solution, int format_version);

/// Sets what describe() told. @return Whether the file has importance.
/// @throws std::exception where something is missing, unknown or of another version.
bool read_description(std::string_view text, int oldest_format_version, int newest_format_version, SolvedScene& solved);

}  // namespace interflect::inline detail
