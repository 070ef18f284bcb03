#include "interflect/formats/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "interflect/core.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

bool is_binary(char c) {
    const auto byte = static_cast<unsigned char>(c);
    // Bitwise operators allow vectorisation.
    return (byte < '\t') | ((byte > '\r') & (byte < ' ')) | (byte == 0x7f);
}

}  // namespace

void require_text(std::string_view text, const fs::path& path) {
    if (std::count_if(text.begin(), text.end(), is_binary) == 0) return;
    const auto junk = std::find_if(text.begin(), text.end(), is_binary);
    throw InputError(path, 1 + std::count(text.begin(), junk, '\n'),
                     fmt::format("this is not a text file: it has a byte 0x{:02x} at offset {}",
                                 static_cast<unsigned char>(*junk), junk - text.begin()));
}

void require_regular_file(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error == std::errc::too_many_symbolic_link_levels)
        throw InputError(path, 0, "its symbolic links lead in a circle");
    if (!fs::exists(status)) throw InputError(path, 0, "there is no such file");
    if (fs::is_directory(status)) throw InputError(path, 0, "this is a folder, not a file");
    if (!fs::is_regular_file(status)) throw InputError(path, 0, "this is not a regular file");
}

bool is_within(const fs::path& path, const fs::path& folder) {
    std::error_code error;
    const auto resolved = [&](const fs::path& given) {  // else nonexistent paths stay relative
        const fs::path whole = fs::absolute(given, error);
        return error ? fs::path() : fs::weakly_canonical(whole, error);
    };
    const fs::path place = resolved(path);
    const fs::path home = error ? fs::path() : resolved(folder.empty() ? "." : folder);
    if (error) return false;
    const auto [end, ignored] = std::mismatch(home.begin(), home.end(), place.begin(), place.end());
    return end == home.end();
}

std::string read_bytes(const fs::path& path, std::uintmax_t most) {
    require_regular_file(path);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error && size > most)
        throw InputError(path, 0, fmt::format("it has {} bytes; at most {} are read", size, most));
    std::ifstream file(path, std::ios::binary);
    if (error || !file) throw InputError(path, 0, "the file cannot be opened for reading");
    std::string text(static_cast<std::size_t>(size), '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (file.gcount() != static_cast<std::streamsize>(text.size()))
        throw InputError(path, 0, fmt::format("only {} of {} bytes could be read", file.gcount(), text.size()));
    return text;
}

std::string read_text_file(const fs::path& path) {
    std::string text = read_bytes(path);
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
    require_text(text, path);
    return text;
}

}  // namespace interflect::detail
