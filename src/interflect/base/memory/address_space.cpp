#include "interflect/base/memory/address_space.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <string>

namespace interflect::detail {

namespace {

std::size_t reserved_address_space() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::string mebibytes(std::size_t bytes) { return std::to_string((bytes >> 20) + 1) + " MiB"; }

}  // namespace

std::size_t free_address_space() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::numeric_limits<std::size_t>::max();
    const std::size_t reserved = reserved_address_space();
    return limit.rlim_cur > reserved ? limit.rlim_cur - reserved : 0;
}

AddressSpaceError::AddressSpaceError(std::size_t bytes)
    : std::runtime_error("cannot reserve " + mebibytes(bytes) +
                         " of address space: expected a higher limit of it (ulimit -v) or a lower one of elements") {}

}  // namespace interflect::detail
