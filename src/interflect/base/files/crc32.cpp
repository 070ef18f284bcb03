#include "interflect/base/files/crc32.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <fstream>
#include <stdexcept>
#include <vector>

namespace interflect::detail {

std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far) {
    return libdeflate_crc32(so_far, bytes.data(), bytes.size());
}

std::uint32_t crc32_of_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> buffer(std::size_t{1} << 18);
    std::uint32_t checksum = 0;
    while (file) {
        file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        checksum = crc32({buffer.data(), static_cast<std::size_t>(file.gcount())}, checksum);
    }
    if (!file.eof()) throw std::runtime_error(fmt::format("{}: cannot be read", path.string()));
    return checksum;
}

std::string text_of_crc32(std::uint32_t checksum) { return fmt::format("{:08x}", checksum); }

}  // namespace interflect::detail
