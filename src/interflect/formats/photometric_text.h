#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// Reads a photometric file without its byte order mark and MS-DOS end mark (0x1a).
/// @throws InputError  as read_text_file(), and beyond options.max_photometric_bytes.
std::string read_photometric_text(const std::filesystem::path& path, const ReadOptions& options);

/// Reads photometric text by line or by word. Lines end with LF, CR or both. Errors are InputErrors with the file and
/// the line read last.
class PhotometricText {
  public:
    /// @param separators  Word separators besides white space.
    PhotometricText(std::string_view text, const std::filesystem::path& path, std::string_view separators)
        : text_(text), path_(path), separators_(separators) {}

    /// Returns the next line, trimmed; nullopt at the end.
    std::optional<std::string_view> line();
    /// Returns the next word of this or a later line; nullopt at the end.
    std::optional<std::string_view> word();

    /// Reads a number. @param what  For errors: "the lamp's flux".
    double number(const std::string& what);
    /// Reads an integer in [least, most].
    std::size_t count(const std::string& what, std::size_t least, std::size_t most);
    std::vector<double> numbers(std::size_t count, const std::string& what);
    /// Returns whether a decimal comma occurred.
    bool had_decimal_comma() const { return had_decimal_comma_; }

    /// Parses a number, which may have a decimal comma unless commas are separators.
    double number_of(std::string_view word, const std::string& what);

    std::string where() const;  ///< "file:line" of the last read.
    [[noreturn]] void refuse(const std::string& message) const;

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

}  // namespace interflect::inline detail
