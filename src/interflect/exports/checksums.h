#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace interflect::inline detail {

/// Bytes at the beginning of a file that its checksums take: an HDF5 user block, which readers of HDF5 skip.
inline constexpr std::uint64_t checksum_block_size = 4096;

/// A named range of a file's bytes.
struct FileRange {
    std::string name;  ///< Without white space.
    std::uint64_t begin = 0, length = 0;
};

/// Fills the first checksum_block_size bytes of a finished file with CRC-32 checksums of all others: one of each of the
/// ranges, which neither overlap nor reach into the block (of arrays that are numbered in their group, one of all), one
/// of what lies before, between and after them, and one of the block itself. docs/solution-file.md has the layout.
/// Cost: one pass over the file, several GB/s.
/// @throws std::runtime_error where the file cannot be read or written.
void write_checksums(const std::filesystem::path& path, std::vector<FileRange> ranges);

/// Whether the file at `path` begins like one with checksums; false when it cannot be read.
bool has_checksums(const std::filesystem::path& path);

/// Compares every byte of a file with its checksums: each change within 32 bits is found, others but for one in 2^32.
/// Cost: as write_checksums().
/// @throws std::runtime_error that names the first range that is damaged.
void verify_checksums(const std::filesystem::path& path);

}  // namespace interflect::inline detail
