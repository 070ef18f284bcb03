#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace interflect::inline detail {

/// Size of the checksum block at the beginning of a file: an HDF5 user block, which HDF5 readers skip [bytes].
inline constexpr std::uint64_t checksum_block_size = 4096;

struct FileRange {
    std::string name;  ///< No white space.
    std::uint64_t begin = 0, length = 0;
};

/// Fills the first checksum_block_size bytes of a finished file with CRC-32 checksums of all other bytes. Each range
/// has one, numbered arrays of one group share one, and so do the gaps; the block has its own. Layout:
/// docs/solution-file.md.
/// @param ranges  Disjoint and outside the block. Cost: one pass over the file, several GB/s.
/// @throws std::runtime_error if the file cannot be read or written.
void write_checksums(const std::filesystem::path& path, std::vector<FileRange> ranges);

/// Returns whether the file begins with a checksum block; false if it cannot be read.
bool has_checksums(const std::filesystem::path& path);

/// Compares every byte of a file with its checksums. Detects every change within 32 bits; misses others with
/// probability 2^-32. Cost: that of write_checksums().
/// @throws std::runtime_error naming the first damaged range.
void verify_checksums(const std::filesystem::path& path);

}  // namespace interflect::inline detail
