#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace interflect::detail {

/// Splits lines into words; a final backslash joins two lines.
class LineReader {
  public:
    struct Position {
        std::size_t offset = 0;
        std::int64_t line = 1;  ///< Number of the line, from 1.
    };

    explicit LineReader(std::string_view text) : text_(text) {}

    /// Moves to the next line that is not blank. @return  false at the end.
    bool next();

    std::span<const std::string_view> words() const { return words_; }  ///< Valid until next().
    /// Returns the text from the second word on.
    std::string_view rest() const {
        if (words_.size() < 2) return {};
        return {words_[1].data(), words_.back().data() + words_.back().size()};
    }
    std::int64_t line() const { return line_; }     ///< Number of the line, from 1.
    std::size_t length() const { return length_; }  ///< [characters], including joined lines

    Position position() const { return next_; }
    void seek(const Position& position) { next_ = position; }

  private:
    /// @param offset  Place of a backslash.
    bool at_continuation(std::size_t offset) const;
    std::size_t end_of_word(std::size_t offset) const;

    std::string_view text_;
    Position next_;
    std::int64_t line_ = 0;
    std::size_t length_ = 0;
    std::vector<std::string_view> words_;
};

}  // namespace interflect::detail
