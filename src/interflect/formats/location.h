#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "interflect/error.h"
#include "interflect/formats/foreign_text.h"

namespace interflect::inline detail {

/// A place in a file, for messages: a line of text, or a part with a name.
struct Location {
    const std::filesystem::path* file = nullptr;
    std::int64_t line = 0;       ///< 1-based; 0 where the file has no lines.
    std::string_view part = {};  ///< Such as "mesh 'chair'"; may be empty.
    bool is_foreign = false;     ///< Another file names this file, so messages do not quote it.

    std::string text() const {
        if (!file) return {};
        if (line > 0) return fmt::format("{}:{}", file->string(), line);
        return part.empty() ? file->string() : fmt::format("{}: {}", file->string(), part);
    }
    /// A message about this place, as users may see it.
    std::string shown(const std::string& message) const { return is_foreign ? without_quotes(message) : message; }
    /// The error that tells what is wrong there. @param Error  InputError, or what is constructed like it.
    template <class Error = InputError>
    Error error(const std::string& message) const {
        return Error(*file, line, part.empty() ? shown(message) : fmt::format("{}: {}", part, shown(message)));
    }
};

}  // namespace interflect::inline detail
