#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

#include <ImathVec.h>

namespace interflect::detail {

/// Words of a line, or its arguments.
using MgfWords = std::span<const std::string_view>;

/// Error in the current line, without its place.
using MgfFault = std::invalid_argument;

/// @throws MgfFault  unless the word is a finite number in single precision.
double number_argument(std::string_view word);

/// @throws MgfFault  also for a negative number.
double non_negative_argument(std::string_view word);

/// Converts the first three words. @throws MgfFault
Imath::V3d vector_argument(MgfWords words);

/// Returns whether three of the words differ from each other.
bool has_three_distinct(MgfWords words);

}  // namespace interflect::detail
