#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/read_options.h"

namespace interflect::inline detail {

/// The text of a file with measured light, without the byte order mark and the end mark (0x1a) that some have.
/// @throws InputError as read_text_file() does, and beyond options.max_photometric_bytes.
std::string read_photometric_text(const std::filesystem::path& path, const ReadOptions& options);

/// Reads such a text line by line or word by word. Lines end with LF, CR or both. What is wrong is an InputError with
/// the file and the line of what was read last.
class PhotometricText {
  public:
    /// @param separators  That stand between words beside white space.
    PhotometricText(std::string_view text, const std::filesystem::path& path, std::string_view separators)
        : text_(text), path_(path), separators_(separators) {}

    /// The next line without white space at its ends; nothing at the end of the text.
    std::optional<std::string_view> line();
    /// The next word of this or a later line; nothing at the end of the text.
    std::optional<std::string_view> word();

    /// The next word, a number. @param what  "the lamp's flux", for the error.
    double number(const std::string& what);
    /// One that is whole, and from `least` to `most`.
    std::size_t count(const std::string& what, std::size_t least, std::size_t most);
    std::vector<double> numbers(std::size_t count, const std::string& what);
    /// Where decimal commas are allowed: whether there were any.
    bool had_decimal_comma() const { return had_decimal_comma_; }

    /// @param word  Stands for a number where no separator is a comma, and may have a decimal one.
    double number_of(std::string_view word, const std::string& what);

    std::string where() const;  ///< "file:line" of what was read last.
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
