#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

namespace interflect::detail {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Returns the size of a value in binary form [bytes].
std::size_t size_of(PlyType type);

/// Values after the header, read one after the other.
class PlyValues {
  public:
    enum class Form { ascii, little_endian, big_endian };

    PlyValues(std::string_view bytes, Form form) : bytes_(bytes), rest_(bytes), form_(form) {}

    /// Returns the number of line breaks read, or nullopt for a binary file.
    std::optional<std::int64_t> lines() const;

    /// Returns the next value. Binary values may be infinite or NaN. @throws std::invalid_argument
    double next(PlyType type);
    bool is_at_end() const;
    /// Returns the number of remaining lines that are not blank, or nullopt for a binary file.
    std::optional<std::uint64_t> lines_left() const;
    /// Skips the rest of the line. Returns whether it has values.
    bool skip_line();
    /// Returns whether the rest may contain `values` values, or `bytes` bytes of a binary file. A value in text takes
    /// two characters, except the last one.
    bool may_hold(std::uint64_t values, std::uint64_t bytes) const {
        return form_ == Form::ascii ? values <= (rest_.size() + 1) / 2 : bytes <= rest_.size();
    }

  private:
    double next_word();

    std::string_view bytes_, rest_;
    Form form_;
};

}  // namespace interflect::detail
