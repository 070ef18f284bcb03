#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace interflect::detail {

/// Size of the user block at the start of a file that contains the checksums [bytes].
inline constexpr std::uint64_t checksum_block_size = 4096;

struct FileRange {
    std::string name;  ///< Must not contain white space.
    std::uint64_t begin = 0, length = 0;
};

/// Writes CRC-32 checksums into the user block of a finished file (docs/files/solution-file.md).
/// @param ranges  Disjoint and outside the block.
/// @throws std::runtime_error if the file cannot be read or written.
void write_checksums(const std::filesystem::path& path, std::vector<FileRange> ranges);

/// Returns whether the file begins with checksums; false if it is unreadable.
bool has_checksums(const std::filesystem::path& path);

/// Verifies every byte; misses a change with probability <= 2^-32.
/// @throws std::runtime_error naming the first damaged range.
void verify_checksums(const std::filesystem::path& path);

}  // namespace interflect::detail
