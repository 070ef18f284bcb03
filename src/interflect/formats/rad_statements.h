#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// Primitive (`modifier type name` with arguments) or `modifier alias name original`. Words are views of the text.
struct RadPrimitive {
    std::string_view modifier, type, name;
    std::string_view original;  ///< For aliases only.
    std::vector<std::string_view> strings;
    std::vector<double> numbers;
};

/// Splits a Radiance scene into statements: primitives, and commands that begin with `!`. Comments start with `#`
/// between statements and end with the line. Words may be quoted with ' or ".
class RadStatements {
  public:
    enum class Kind { primitive, command, end };

    explicit RadStatements(std::string_view text) : text_(text) {}

    /// Advances to the next statement.
    Kind next();
    std::int64_t line() const { return line_; }  ///< First line of the statement, from 1.

    /// Returns the command without `!`, with continued lines joined.
    std::string command();
    /// Parses the primitive. @throws std::invalid_argument  with a sentence if it is truncated or malformed.
    RadPrimitive primitive();

  private:
    void skip_blanks();
    std::string_view word(std::string_view expected);
    std::size_t count(std::string_view of);

    std::string_view text_;
    std::size_t offset_ = 0;
    std::int64_t line_ = 1, line_of_offset_ = 1;
};

}  // namespace interflect::inline detail
