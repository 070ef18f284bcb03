#pragma once

#include <cstddef>
#include <string_view>

namespace interflect::command {

/// Memory that the process may take [bytes]: what the machine has, less what its control groups allow.
std::size_t machine_memory();

/// Memory for which it may have addresses [bytes]: what it uses and half of what a limit (ulimit -v)
/// leaves, since arrays are reserved at their largest, as are stacks; the largest number where there is no limit.
std::size_t addressable_memory();

/// Resident memory of this process [bytes].
std::size_t memory_in_use();

/// Limit of the process [bytes]: nine tenths of machine_memory(), but at most addressable_memory().
std::size_t usable_memory();

/// Usable memory that is not in use yet [bytes].
std::size_t free_memory();

/// Refuses work before it allocates memory.
/// @param bytes   Peak of the whole process.
/// @param what    The work: "a picture of 640 x 360 pixels".
/// @param remedy  Advice: "a smaller --size needs less"; may be empty.
/// @throws std::runtime_error with these three if `bytes` exceeds usable_memory().
void require_memory(std::size_t bytes, std::string_view what, std::string_view remedy = {});

/// The same for bytes in addition to memory_in_use().
void require_free_memory(std::size_t bytes, std::string_view what, std::string_view remedy = {});

}  // namespace interflect::command
