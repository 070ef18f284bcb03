#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "interflect/error.h"

namespace interflect::inline detail {

/// A place in a file, for messages: a line of text, or a part with a name.
struct Location {
    const std::filesystem::path* file = nullptr;
    std::int64_t line = 0;       ///< 1-based; 0 where the file has no lines.
    std::string_view part = {};  ///< Such as "mesh 'chair'"; may be empty.

    std::string text() const {
        if (!file) return {};
        if (line > 0) return fmt::format("{}:{}", file->string(), line);
        return part.empty() ? file->string() : fmt::format("{}: {}", file->string(), part);
    }
    /// The error that tells what is wrong there. @param Error  InputError, or what is constructed like it.
    template <class Error = InputError>
    Error error(const std::string& message) const {
        return Error(*file, line, part.empty() ? message : fmt::format("{}: {}", part, message));
    }
};

}  // namespace interflect::inline detail
