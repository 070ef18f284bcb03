#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

#include <ImathVec.h>

namespace interflect::inline detail {

/// The words of a line of an MGF file, or its arguments.
using MgfWords = std::span<const std::string_view>;

/// What is wrong with the line being read; where it is read, file and line are added.
using MgfFault = std::invalid_argument;

/// @throws MgfFault where the word is not a finite number in single precision.
double number_argument(std::string_view word);

/// @throws MgfFault as number_argument() does, and for a negative one.
double non_negative_argument(std::string_view word);

/// The first three words as a vector. @throws MgfFault as number_argument() does.
Imath::V3d vector_argument(MgfWords words);

/// Whether the words hold three that differ from each other.
bool has_three_distinct(MgfWords words);

}  // namespace interflect::inline detail
