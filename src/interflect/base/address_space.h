#pragma once

#include <cstddef>
#include <stdexcept>

namespace interflect::detail {

/// Address space still available to the process [bytes], by RLIMIT_AS (ulimit -v); the largest number without a limit.
std::size_t free_address_space();

/// Address space cannot be reserved.
class AddressSpaceError : public std::runtime_error {
  public:
    explicit AddressSpaceError(std::size_t bytes);
};

}  // namespace interflect::detail
