#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace interflect::detail {

/// Statement `modifier type name` with arguments, or `modifier alias name original`.
struct RadPrimitive {
    std::string_view modifier, type, name;
    std::string_view original;  ///< Alias only.
    std::vector<std::string_view> strings;
    std::vector<double> numbers;
};

/// Splits a file into statements. Comments (`#`) start between statements. Words may be quoted with ' or ".
class RadStatements {
  public:
    enum class Kind { primitive, command, end };

    explicit RadStatements(std::string_view text) : text_(text) {}

    /// Moves to the next statement.
    Kind next();
    std::int64_t line() const { return line_; }  ///< Line at which the statement starts, from 1.

    /// Returns the command with its continued lines joined.
    std::string command();
    /// @throws std::invalid_argument
    RadPrimitive primitive();

  private:
    void skip_blanks();
    std::string_view word(std::string_view expected);
    std::size_t count(std::string_view kind);

    std::string_view text_;
    std::size_t offset_ = 0;
    std::int64_t line_ = 1, line_of_offset_ = 1;
};

}  // namespace interflect::detail
