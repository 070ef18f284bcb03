#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "interflect/base/escapes.h"

namespace interflect::command {

// All text output is escaped(), so names in files cannot control the terminal.

/// Sends spdlog's messages to stderr. Keeps only line breaks before indented lines: lists of faults.
void log_to_stderr();

/// Prints one line of results to stdout.
template <class... Arguments>
void print_line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::print("{}\n", escaped(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

}  // namespace interflect::command
