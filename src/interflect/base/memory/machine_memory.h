#pragma once

#include <cstddef>
#include <string_view>

namespace interflect::detail {

/// Returns the memory of the machine or its control groups, whichever is smaller [bytes].
std::size_t machine_memory();

/// Returns the memory in use plus half of the free address space (ulimit -v) [bytes], because arrays and stacks reserve
/// their largest size. Without a limit, returns the largest number.
std::size_t addressable_memory();

/// Returns the resident memory of this process [bytes].
std::size_t memory_in_use();

/// Returns nine tenths of machine_memory(), at most addressable_memory() [bytes].
std::size_t usable_memory();

/// Returns the usable memory that is not in use [bytes].
std::size_t free_memory();

/// Refuses work before it allocates memory.
/// @param bytes   Peak of the whole process.
/// @param what    Name of the work: "a picture of 640 x 360 pixels".
/// @param remedy  Advice, such as "a smaller picture needs less"; may be empty.
/// @throws std::runtime_error with these three if `bytes` exceeds usable_memory().
void require_memory(std::size_t bytes, std::string_view what, std::string_view remedy = {});

/// Requires memory for these bytes in addition to memory_in_use().
void require_free_memory(std::size_t bytes, std::string_view what, std::string_view remedy = {});

}  // namespace interflect::detail
