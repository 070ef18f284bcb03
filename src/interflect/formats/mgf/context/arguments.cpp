#include "interflect/formats/mgf/context/arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/formats/text/number.h"

namespace interflect::detail {

double number_argument(std::string_view word) {
    if (const auto value = parse_number(word)) return *value;
    throw MgfFault(fmt::format("'{}' is not a finite number in single precision", word));
}

double non_negative_argument(std::string_view word) {
    const double value = number_argument(word);
    if (value < 0) throw MgfFault(fmt::format("'{}' must not be negative", word));
    return value;
}

Imath::V3d vector_argument(MgfWords words) {
    return {number_argument(words[0]), number_argument(words[1]), number_argument(words[2])};
}

bool has_three_distinct(MgfWords words) {
    if (words.size() > 2 && words[0] != words[1] && words[0] != words[2] && words[1] != words[2]) return true;
    const auto second = std::find_if(words.begin(), words.end(), [&](auto w) { return w != words.front(); });
    return std::any_of(second, words.end(), [&](auto w) { return w != words.front() && w != *second; });
}

}  // namespace interflect::detail
