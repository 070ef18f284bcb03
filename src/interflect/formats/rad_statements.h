#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// `modifier type name` with its arguments, or `modifier alias name original`. Words are views of the text.
struct RadPrimitive {
    std::string_view modifier, type, name;
    std::string_view original;  ///< Only of an alias.
    std::vector<std::string_view> strings;
    std::vector<double> numbers;
};

/// Splits the text of a Radiance scene into statements: primitives, and commands that begin with `!`. Comments reach
/// from `#`, where a statement could begin, to the end of the line; words may be quoted with ' or ".
class RadStatements {
  public:
    enum class Kind { primitive, command, end };

    explicit RadStatements(std::string_view text) : text_(text) {}

    /// Goes to the next statement.
    Kind next();
    std::int64_t line() const { return line_; }  ///< Where the statement starts, from 1.

    /// The command, without the `!` and with continued lines joined.
    std::string command();
    /// The primitive. @throws std::invalid_argument, with a sentence, where it is cut off or not well formed.
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
