#pragma once

#include <cstddef>
#include <stdexcept>

namespace interflect::inline detail {

/// Addresses that the process may still reserve [bytes]: what RLIMIT_AS (ulimit -v) leaves of them; the largest number
/// where there is no such limit.
std::size_t free_address_space();

/// So many addresses cannot be reserved.
class AddressSpaceError : public std::runtime_error {
  public:
    explicit AddressSpaceError(std::size_t bytes);
};

}  // namespace interflect::inline detail
