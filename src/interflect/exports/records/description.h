#pragma once

#include <string>
#include <string_view>

#include "interflect/solution.h"

namespace interflect::detail {

/// Returns the content of a solution file as JSON, except its long arrays.
/// @throws std::runtime_error if a number is not finite.
std::string describe(const Scene& scene, const Solution& solution, int format_version);

/// Parses the text of describe(). Returns whether the file contains importance.
/// @throws std::exception for missing or unknown values and other versions.
bool read_description(std::string_view text, int oldest_format_version, int newest_format_version, SolvedScene& solved);

}  // namespace interflect::detail
