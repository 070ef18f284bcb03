#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

#include <ImathVec.h>

namespace interflect::inline detail {

/// Words of a line of an MGF file, or its arguments.
using MgfWords = std::span<const std::string_view>;

/// Error in the current line. The reader adds file and line.
using MgfFault = std::invalid_argument;

/// @throws MgfFault  if the word is not a finite number in single precision.
double number_argument(std::string_view word);

/// @throws MgfFault  as number_argument(), and for a negative number.
double non_negative_argument(std::string_view word);

/// Returns the first three words as a vector. @throws MgfFault  as number_argument().
Imath::V3d vector_argument(MgfWords words);

/// Returns whether at least three of the words differ from each other.
bool has_three_distinct(MgfWords words);

}  // namespace interflect::inline detail
