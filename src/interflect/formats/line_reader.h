#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::inline detail {

/// Splits a text into lines of words. A backslash right before the end of a line joins the next line to it, and counts
/// as white space. Words are views of the text; nothing is copied.
class LineReader {
  public:
    /// A place between two lines, to come back to.
    struct Position {
        std::size_t offset = 0;
        std::int64_t line = 1;  ///< Number of the line that starts here, from 1.
    };

    explicit LineReader(std::string_view text) : text_(text) {}

    /// Goes on to the next line that has a word. @return false at the end of the text.
    bool next();

    std::span<const std::string_view> words() const { return words_; }  ///< Valid until the next call of next().
    /// The text from the second word to the end of the last one as it stands: a name that may have spaces.
    /// Empty where there is one word only.
    std::string_view rest() const {
        if (words_.size() < 2) return {};
        return {words_[1].data(), words_.back().data() + words_.back().size()};
    }
    std::int64_t line() const { return line_; }     ///< Where the current line starts, from 1.
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
