#pragma once

#include <cstddef>

namespace interflect::command {

/// Memory that the process may take [bytes]: what the machine has, less what its control groups allow.
std::size_t machine_memory();

/// Memory for which it may have addresses [bytes]: what it uses and half of what a limit (ulimit -v)
/// leaves, since arrays are reserved at their largest, as are stacks; the largest number where there is no limit.
std::size_t addressable_memory();

}  // namespace interflect::command
