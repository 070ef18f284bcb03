#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace interflect::detail {

/// Size of the block at the beginning of a file [bytes]: an HDF5 user block, which HDF5 readers skip.
inline constexpr std::uint64_t checksum_block_size = 4096;

struct FileRange {
    std::string name;  ///< No white space.
    std::uint64_t begin = 0, length = 0;
};

/// Fills the first checksum_block_size bytes of a finished file with CRC-32 checksums (docs/solution-file.md): one per
/// range, one per gap between them, and one of the block itself. Neighbouring numbered arrays of one group share a
/// checksum. Cost: one pass over the file, several GB/s.
/// @param ranges  Disjoint and outside the block.
/// @throws std::runtime_error if the file cannot be read or written.
void write_checksums(const std::filesystem::path& path, std::vector<FileRange> ranges);

/// Returns false also for an unreadable file.
bool has_checksums(const std::filesystem::path& path);

/// Compares every byte with the checksums, at the cost of write_checksums(). Detects every change within 32 bits and
/// misses others with probability 2^-32.
/// @throws std::runtime_error naming the first damaged range.
void verify_checksums(const std::filesystem::path& path);

}  // namespace interflect::detail
