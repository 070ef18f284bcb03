#include "interflect/base/files/input_file.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "interflect/base/memory/machine_memory.h"
#include "interflect/core.h"

namespace interflect::detail {

namespace fs = std::filesystem;

/// Smaller files are read without a memory check, which itself reads files [bytes].
constexpr std::uintmax_t small_file = std::uintmax_t{1} << 24;

void require_regular_file(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error == std::errc::too_many_symbolic_link_levels)
        throw InputError(path, 0, "its symbolic links lead in a circle");
    if (!fs::exists(status)) throw InputError(path, 0, "no such file");
    if (fs::is_directory(status)) throw InputError(path, 0, "this is a folder, not a file");
    if (!fs::is_regular_file(status)) throw InputError(path, 0, "this is not a regular file");
}

std::string read_bytes(const fs::path& path, std::uintmax_t most) {
    require_regular_file(path);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error && size > most)
        throw InputError(path, 0, fmt::format("it has {} bytes; at most {} are read", size, most));
    if (!error && size > small_file) require_free_memory(size, "reading " + path.string());
    std::ifstream file(path, std::ios::binary);
    if (error || !file) throw InputError(path, 0, "the file cannot be opened for reading");
    std::string text(static_cast<std::size_t>(size), '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (file.gcount() != static_cast<std::streamsize>(text.size()))
        throw InputError(path, 0, fmt::format("only {} of {} bytes could be read", file.gcount(), text.size()));
    return text;
}

}  // namespace interflect::detail
