#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace interflect::detail {

/// CRC-32 as in zlib. @param so_far  Checksum of the preceding bytes.
std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0);

/// @throws std::runtime_error if the file cannot be read.
std::uint32_t crc32_of_file(const std::filesystem::path& path);

/// Returns the checksum as eight lower-case hexadecimal digits.
std::string text_of_crc32(std::uint32_t checksum);

}  // namespace interflect::detail
