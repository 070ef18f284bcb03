#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "interflect/core.h"
#include "interflect/formats/reading/read_fault.h"
#include "interflect/formats/text/foreign_text.h"

namespace interflect::detail {

/// Place of a fault, for messages.
struct Location {
    const std::filesystem::path* file = nullptr;
    std::int64_t line = 0;        ///< Number from 1; 0 for files without lines.
    std::string_view part = {};   ///< Part of the file, such as "mesh 'chair'", or empty.
    bool forbids_quotes = false;  ///< Whether messages hide the file's content, because another file refers to it.

    std::string text() const {
        if (!file) return {};
        if (line > 0) return fmt::format("{}:{}", file->string(), line);
        return part.empty() ? file->string() : fmt::format("{}: {}", file->string(), part);
    }
    std::string shown(const std::string& message) const { return forbids_quotes ? without_quotes(message) : message; }
    /// @param setting  Fault::setting.
    InputError error(const std::string& message, const std::string& setting = {}) const {
        const std::string text = part.empty() ? shown(message) : fmt::format("{}: {}", part, shown(message));
        return InputError(Fault{text, std::string(part), setting, *file, line});
    }
    InputError error(const std::invalid_argument& fault) const { return error(fault.what(), setting_of(fault)); }
};

}  // namespace interflect::detail
