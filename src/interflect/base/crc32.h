#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace interflect::inline detail {

/// The CRC-32 of zlib and of Python's zlib.crc32(). @param so_far  Of the bytes before these.
std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0);

/// Of all bytes of a file. Cost: one pass over it, several GB/s. @throws std::runtime_error where it cannot be read.
std::uint32_t crc32_of_file(const std::filesystem::path& path);

/// Eight lower-case hexadecimal digits.
std::string text_of_crc32(std::uint32_t checksum);

}  // namespace interflect::inline detail
