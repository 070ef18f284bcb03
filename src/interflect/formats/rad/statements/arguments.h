#pragma once

#include <fmt/format.h>

#include <ImathVec.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "interflect/formats/text/number.h"

namespace interflect::detail {

/// Arguments of a built-in command of Radiance, from left to right. All functions throw std::invalid_argument, with the
/// name of the command and the expected argument.
class RadArguments {
  public:
    /// @param words  The command and its arguments.
    explicit RadArguments(std::span<const std::string> words) : command_(words[0]), left_(words.subspan(1)) {}

    bool is_at_end() const { return left_.empty(); }
    std::string next(std::string_view expected = "another argument") {
        if (left_.empty()) throw std::invalid_argument(fmt::format("{} ends where {} is expected", command_, expected));
        std::string result = left_.front();
        left_ = left_.subspan(1);
        return result;
    }
    double number(std::string_view expected = "a number") {
        const std::string word = next(expected);
        const auto value = parse_number(word);
        if (!value) throw std::invalid_argument(fmt::format("{}: expected {}, not '{}'", command_, expected, word));
        return *value;
    }
    Imath::V3d vector(std::string_view expected) {
        const double x = number(expected), y = number(expected), z = number(expected);
        return {x, y, z};
    }
    int whole_number(int least, int most) {
        const std::string word = next();
        const auto value = parse_integer(word);
        if (!value || *value < least || *value > most)
            throw std::invalid_argument(
                fmt::format("{}: expected a number from {} to {}, not '{}'", command_, least, most, word));
        return static_cast<int>(*value);
    }

  private:
    std::string command_;
    std::span<const std::string> left_;
};

}  // namespace interflect::detail
