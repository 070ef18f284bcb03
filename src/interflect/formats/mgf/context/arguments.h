#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

#include <ImathVec.h>

namespace interflect::detail {

using MgfWords = std::span<const std::string_view>;

/// Error whose message does not name the place.
using MgfFault = std::invalid_argument;

/// @throws MgfFault unless the number is finite in single precision.
double number_argument(std::string_view word);

/// @throws MgfFault also for negative numbers.
double non_negative_argument(std::string_view word);

/// @throws MgfFault
Imath::V3d vector_argument(MgfWords words);

bool has_three_distinct(MgfWords words);

}  // namespace interflect::detail
