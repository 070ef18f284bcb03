#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

namespace interflect::detail {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// In binary form [bytes].
std::size_t size_of(PlyType type);

/// Reads the values after a PLY header.
class PlyValues {
  public:
    enum class Form { ascii, little_endian, big_endian };

    PlyValues(std::string_view bytes, Form form) : bytes_(bytes), rest_(bytes), form_(form) {}

    /// Returns the line breaks up to the last value read; nullopt for binary forms.
    std::optional<std::int64_t> lines() const;

    /// @throws std::invalid_argument  at the end and for invalid numbers. Binary values may be infinite or NaN.
    double next(PlyType type);
    /// Returns whether only blanks remain.
    bool is_at_end() const;
    /// Returns whether enough bytes remain. In text, each value but the last takes at least two characters.
    bool may_hold(std::uint64_t values, std::uint64_t bytes) const {
        return form_ == Form::ascii ? values <= (rest_.size() + 1) / 2 : bytes <= rest_.size();
    }

  private:
    double next_word();

    std::string_view bytes_, rest_;
    Form form_;
};

}  // namespace interflect::detail
