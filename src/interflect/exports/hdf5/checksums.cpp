#include "interflect/exports/hdf5/checksums.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "interflect/base/files/crc32.h"

namespace interflect::detail {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view signature = "interflect checksums\n";
/// Name of ranges between arrays, which contain the structure of the HDF5 file.
constexpr const char* structure = "structure";
/// The checksum of the block itself, at its end, has eight hexadecimal digits and a line break.
constexpr std::size_t own_checksum_length = 9, checked_length = checksum_block_size - own_checksum_length;

std::string own_checksum(std::string_view block) {
    return text_of_crc32(crc32(block.substr(0, checked_length))) + "\n";
}

std::optional<std::uint32_t> checksum_of(std::ifstream& file, const FileRange& range) {
    std::array<char, 1 << 18> buffer;
    std::uint32_t checksum = 0;
    file.clear();
    file.seekg(static_cast<std::streamoff>(range.begin));
    for (std::uint64_t left = range.length; left > 0;) {
        const std::size_t size = std::min<std::uint64_t>(left, buffer.size());
        if (!file.read(buffer.data(), static_cast<std::streamsize>(size))) return std::nullopt;
        checksum = crc32({buffer.data(), size}, checksum);
        left -= size;
    }
    return checksum;
}

/// Returns the common name of numbered arrays, such as "/groups" for "/groups/3".
std::string_view checked_name(std::string_view name) {
    const std::size_t last = name.find_last_not_of("0123456789");
    const bool is_numbered = last + 1 < name.size() && name[last] == '/';
    return is_numbered ? name.substr(0, last) : name;
}

/// Joins the ranges of numbered arrays, because the size of the block is limited.
std::vector<FileRange> with_numbered_joined(const std::vector<FileRange>& ranges) {
    std::vector<FileRange> joined;
    for (const FileRange& range : ranges) {
        const std::string name(checked_name(range.name));
        if (!joined.empty() && joined.back().name == name)
            joined.back().length = range.begin + range.length - joined.back().begin;
        else
            joined.push_back({name, range.begin, range.length});
    }
    return joined;
}

/// Sorts the ranges, joins numbered arrays, and fills gaps outside the block.
std::vector<FileRange> partition(std::vector<FileRange> ranges, std::uint64_t size) {
    std::sort(ranges.begin(), ranges.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
    ranges = with_numbered_joined(ranges);
    std::vector<FileRange> all;
    std::uint64_t end = checksum_block_size;
    const auto fill_up_to = [&](std::uint64_t begin) {
        if (begin < end) throw std::runtime_error("ranges of the file overlap");
        if (begin > end) all.push_back({structure, end, begin - end});
    };
    for (const FileRange& range : ranges) {
        fill_up_to(range.begin);
        all.push_back(range);
        end = range.begin + range.length;
    }
    fill_up_to(size);
    return all;
}

std::string read_block(std::ifstream& file) {
    std::string block(checksum_block_size, '\0');
    if (!file.read(block.data(), static_cast<std::streamsize>(block.size())))
        throw std::runtime_error("the file is damaged: it ends early");
    return block;
}

std::string_view next_word(std::string_view& line) {
    const std::string_view word = line.substr(0, line.find(' '));
    line.remove_prefix(std::min(word.size() + 1, line.size()));
    return word;
}

std::uint64_t next_number(std::string_view& line) {
    const std::string_view word = next_word(line);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size())
        throw std::runtime_error("its checksums are no table");
    return number;
}

struct CheckedRange {
    FileRange range;
    std::string_view checksum;
};

std::vector<CheckedRange> parse(std::string_view block) {
    std::string_view lines = block.substr(signature.size(), checked_length - signature.size());
    std::vector<CheckedRange> ranges;
    while (!lines.empty() && lines.front() != '\n') {
        std::string_view line = lines.substr(0, lines.find('\n'));
        lines.remove_prefix(std::min(line.size() + 1, lines.size()));
        CheckedRange& r = ranges.emplace_back();
        r.checksum = next_word(line);
        r.range.begin = next_number(line);
        r.range.length = next_number(line);
        r.range.name = line;
    }
    return ranges;
}

}  // namespace

void write_checksums(const fs::path& path, std::vector<FileRange> ranges) {
    std::string block(signature);
    std::ifstream written(path, std::ios::binary);
    for (const FileRange& range : partition(std::move(ranges), fs::file_size(path))) {
        const std::optional<std::uint32_t> checksum = checksum_of(written, range);
        if (!checksum) throw std::runtime_error("cannot read the written data");
        block += fmt::format("{} {} {} {}\n", text_of_crc32(*checksum), range.begin, range.length, range.name);
    }
    if (block.size() > checked_length) throw std::runtime_error("too many ranges for the block of checksums");
    block.resize(checked_length, '\n');
    block += own_checksum(block);
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.write(block.data(), static_cast<std::streamsize>(block.size()));
    if (!file.flush()) throw std::runtime_error(std::string("cannot write the checksums: ") + std::strerror(errno));
}

bool has_checksums(const fs::path& path) {
    std::string begin(signature.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == signature;
}

void verify_checksums(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string block = read_block(file);
    if (!block.starts_with(signature) || block.substr(checked_length) != own_checksum(block))
        throw std::runtime_error("the file is damaged: the checksum of its table of checksums differs");
    std::uint64_t end = checksum_block_size;
    for (const auto& [range, checksum] : parse(block)) {
        if (range.begin != end) throw std::runtime_error("its checksums leave bytes out");
        end += range.length;
        const std::optional<std::uint32_t> found = checksum_of(file, range);
        if (!found) throw std::runtime_error(fmt::format("the file is damaged: it ends early, in {}", range.name));
        if (text_of_crc32(*found) != checksum)
            throw std::runtime_error(
                fmt::format("the file is damaged: the checksum of {} differs, expected {}, found {}", range.name,
                            checksum, text_of_crc32(*found)));
    }
    if (fs::file_size(path) != end)
        throw std::runtime_error(
            fmt::format("the file is damaged: it has {} bytes, expected {}", fs::file_size(path), end));
}

}  // namespace interflect::detail
