#include "interflect/base/memory/machine_memory.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "interflect/base/memory/address_space.h"

namespace interflect::detail {

namespace {

/// Returns the path of the process's control group (version 2), or "".
std::string control_group() {
    std::ifstream file("/proc/self/cgroup");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("0::/")) return line.substr(4);
    return {};
}

/// Returns the smallest limit of the control group and its ancestors.
std::size_t control_group_memory() {
    const std::filesystem::path root = "/sys/fs/cgroup";
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (std::filesystem::path group = root / control_group();; group = group.parent_path()) {
        std::size_t bytes = 0;
        if (std::ifstream(group / "memory.max") >> bytes) least = std::min(least, bytes);  // not a number: "max"
        if (group == root || !group.has_relative_path()) return least;
    }
}

}  // namespace

std::size_t machine_memory() {
    const std::size_t physical =
        static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return std::min(physical, control_group_memory());
}

std::size_t memory_in_use() {
    std::size_t reserved = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> reserved >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t addressable_memory() {
    const std::size_t free = free_address_space();
    return free == std::numeric_limits<std::size_t>::max() ? free : memory_in_use() + free / 2;
}

std::size_t usable_memory() { return std::min(machine_memory() / 10 * 9, addressable_memory()); }

std::size_t free_memory() {
    const std::size_t usable = usable_memory();
    return usable - std::min(usable, memory_in_use());
}

void require_memory(std::size_t bytes, std::string_view what, std::string_view remedy) {
    const std::size_t usable = usable_memory();
    if (bytes > usable)
        throw std::runtime_error(
            fmt::format("{} needs {} MiB of memory; the limits of this process (its machine, ulimit -v, control "
                        "groups) leave {} MiB{}{}",
                        what, (bytes >> 20) + 1, usable >> 20, remedy.empty() ? "" : ": ", remedy));
}

void require_free_memory(std::size_t bytes, std::string_view what, std::string_view remedy) {
    require_memory(memory_in_use() + bytes, what, remedy);
}

}  // namespace interflect::detail
