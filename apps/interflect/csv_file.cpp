#include "apps/interflect/csv_file.h"

#include <fmt/format.h>

#include <stdexcept>

#include "interflect/base/escapes.h"

namespace interflect::command {

using namespace detail;

CsvFile::CsvFile(PendingFile& file, const std::string& header)
    : file_(file), stream_(file.temporary_path(), std::ios::binary) {
    add_line(header);
}

void CsvFile::add_line(const std::string& line) { stream_ << line << '\n'; }

void CsvFile::commit() {
    stream_.close();
    if (!stream_) throw std::runtime_error(fmt::format("cannot write '{}'", file_.final_path().string()));
    file_.commit();
}

std::string csv_field(const std::string& text) {
    std::string safe = escaped(text);
    if (safe.find_first_of("\",") == safe.npos) return safe;
    std::string quoted = "\"";
    for (const char c : safe) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace interflect::command
