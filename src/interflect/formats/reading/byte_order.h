#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>

namespace interflect::detail {

/// Decodes a number of this byte order. @param bytes  At least sizeof(Number) bytes.
template <class Number>
Number number_of(std::string_view bytes, std::endian order) {
    std::array<char, sizeof(Number)> raw;
    std::copy_n(bytes.begin(), raw.size(), raw.begin());
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
}

}  // namespace interflect::detail
