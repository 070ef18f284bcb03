#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "interflect/base/escapes.h"

namespace interflect::command {

// Where text leaves the program: names of files and of what they hold cannot command the terminal, being escaped().

/// Sends what spdlog logs to stderr. Of line breaks only those before an indented line remain: lists of faults.
void log_to_stderr();

/// Prints one line of results to stdout.
template <class... Arguments>
void print_line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::print("{}\n", escaped(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

}  // namespace interflect::command
