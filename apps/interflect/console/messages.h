#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "interflect/base/files/escapes.h"

namespace interflect::command {

// Output is escaped(), so names in files cannot control the terminal.

/// Sends spdlog's messages to stderr. Line breaks remain only before indented lines.
void log_to_stderr();

template <class... Arguments>
void print_line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::print("{}\n", detail::escaped(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

}  // namespace interflect::command
