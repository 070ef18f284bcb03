#pragma once

#include <cstddef>
#include <stdexcept>

namespace interflect::detail {

/// Returns the address space left under RLIMIT_AS [bytes], or the type's maximum.
std::size_t free_address_space();

class AddressSpaceError : public std::runtime_error {
  public:
    explicit AddressSpaceError(std::size_t bytes);
};

}  // namespace interflect::detail
