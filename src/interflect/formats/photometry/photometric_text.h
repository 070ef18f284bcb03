#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/load.h"

namespace interflect::detail {

/// Reads a file without its byte order mark and the end mark of MS-DOS.
/// @throws InputError, also for a file of more than max_photometric_bytes.
std::string read_photometric_text(const std::filesystem::path& path, const ReadOptions& options);

/// Reads lines (ended by LF, CR or both) or words. Errors are InputErrors.
class PhotometricText {
  public:
    /// @param separators  Characters that separate words, besides white space.
    PhotometricText(std::string_view text, const std::filesystem::path& path, std::string_view separators)
        : text_(text), path_(path), separators_(separators) {}

    /// Returns the next line without outer white space, or nullopt at the end.
    std::optional<std::string_view> line();
    std::optional<std::string_view> word();

    double number(const std::string& what);
    /// Reads an integer in [least, most].
    std::size_t count(const std::string& what, std::size_t least, std::size_t most);
    std::vector<double> numbers(std::size_t count, const std::string& what);
    bool had_decimal_comma() const { return had_decimal_comma_; }

    /// Parses a number. Accepts a decimal comma, unless commas are separators.
    double number_of(std::string_view word, const std::string& what);

    std::int64_t line_number() const { return line_; }  ///< Returns the line of the latest word.
    std::string where() const;                          ///< Location, such as "room.ies:3".
    [[noreturn]] void refuse(const std::string& message, const std::string& setting = {}) const;

  private:
    bool is_separator(char c) const;
    void skip(std::size_t end);

    std::string_view text_;
    const std::filesystem::path& path_;
    std::string_view separators_;
    std::size_t next_ = 0;
    std::int64_t next_line_ = 1, line_ = 1;
    bool had_decimal_comma_ = false;
};

}  // namespace interflect::detail
