#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// Splits a text into lines of words. A backslash before a line end joins the next line and counts as white space.
/// Words are views of the text.
class LineReader {
  public:
    /// Position between two lines, for seek().
    struct Position {
        std::size_t offset = 0;
        std::int64_t line = 1;  ///< Number of the line that starts here, from 1.
    };

    explicit LineReader(std::string_view text) : text_(text) {}

    /// Advances to the next line with at least one word. @return  false at the end of the text.
    bool next();

    std::span<const std::string_view> words() const { return words_; }  ///< Valid until the next call of next().
    /// Returns the unmodified text from the second word to the end of the last word: a name that may contain spaces.
    /// Empty if the line has only one word.
    std::string_view rest() const {
        if (words_.size() < 2) return {};
        return {words_[1].data(), words_.back().data() + words_.back().size()};
    }
    std::int64_t line() const { return line_; }     ///< Number of the current line's start, from 1.
    std::size_t length() const { return length_; }  ///< Characters, continuations included.

    Position position() const { return next_; }
    void seek(const Position& position) { next_ = position; }

  private:
    bool at_continuation(std::size_t offset) const;

    std::string_view text_;
    Position next_;
    std::int64_t line_ = 0;
    std::size_t length_ = 0;
    std::vector<std::string_view> words_;
};

}  // namespace interflect::inline detail
