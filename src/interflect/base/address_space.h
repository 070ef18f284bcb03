#pragma once

#include <cstddef>
#include <stdexcept>

namespace interflect::inline detail {

/// Address space that the process may still reserve [bytes]: the rest of RLIMIT_AS (ulimit -v), or the largest number
/// without such a limit.
std::size_t free_address_space();

/// Thrown if this amount of address space cannot be reserved.
class AddressSpaceError : public std::runtime_error {
  public:
    explicit AddressSpaceError(std::size_t bytes);
};

}  // namespace interflect::inline detail
