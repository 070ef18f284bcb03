#include "interflect/formats/text/text_file.h"

#include <fmt/format.h>

#include <algorithm>
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

bool is_within(const fs::path& path, const fs::path& folder) {
    std::error_code error;
    const auto resolved = [&](const fs::path& given) {  // weakly_canonical() leaves nonexistent paths relative
        const fs::path whole = fs::absolute(given, error);
        return error ? fs::path() : fs::weakly_canonical(whole, error);
    };
    const fs::path place = resolved(path);
    const fs::path home = error ? fs::path() : resolved(folder.empty() ? "." : folder);
    if (error) return false;
    const auto [end, ignored] = std::mismatch(home.begin(), home.end(), place.begin(), place.end());
    return end == home.end();
}

std::string read_text_file(const fs::path& path) {
    std::string text = read_bytes(path);
    constexpr std::string_view utf8_mark = "\xef\xbb\xbf";
    if (text.starts_with(utf8_mark)) text.erase(0, utf8_mark.size());
    require_text(text, path);
    return text;
}

}  // namespace interflect::detail
