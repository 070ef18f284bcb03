#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace interflect::detail {

/// Refuses folders, pipes, sockets and devices, which may have no end. @throws InputError
void require_regular_file(const std::filesystem::path& path);

/// Reads a regular file. @param most  Maximum size [bytes].
/// @throws InputError if unreadable or larger; std::runtime_error without enough memory.
std::string read_bytes(const std::filesystem::path& path,
                       std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max());

}  // namespace interflect::detail
