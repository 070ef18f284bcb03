#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

namespace interflect::inline detail {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes that a value takes in the binary form.
std::size_t size_of(PlyType type);

/// Reads the values after a PLY file's header one by one.
class PlyValues {
  public:
    enum class Form { ascii, little_endian, big_endian };

    PlyValues(std::string_view bytes, Form form) : bytes_(bytes), rest_(bytes), form_(form) {}

    /// Number of line breaks between the first value and the last value read; no number for binary forms.
    std::optional<std::int64_t> lines() const;

    /// @throws std::invalid_argument  at the end, and for what is no number. Not finite where the binary form is not.
    double next(PlyType type);
    /// Whether so many values of these bytes in all can be left: of text each takes two characters but the last.
    bool may_hold(std::uint64_t values, std::uint64_t bytes) const {
        return form_ == Form::ascii ? values <= (rest_.size() + 1) / 2 : bytes <= rest_.size();
    }

  private:
    double next_word();

    std::string_view bytes_, rest_;
    Form form_;
};

}  // namespace interflect::inline detail
