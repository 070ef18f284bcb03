#include "apps/interflect/values/csv_file.h"

#include "interflect/base/files/escapes.h"

namespace interflect::command {

using namespace detail;

CsvFile::CsvFile(PendingFile& file, const std::string& header) : file_(file) { add_line(header); }

void CsvFile::add_line(const std::string& line) { text_.append(line).append("\n"); }

void CsvFile::commit() {
    file_.write(text_);
    file_.commit();
}

std::string csv_field(const std::string& text) {
    std::string safe = escaped(text);
    if (safe.find_first_of("=+-@") == 0) safe.insert(0, "'");
    if (safe.find_first_of("\",") == safe.npos) return safe;
    std::string quoted = "\"";
    for (const char c : safe) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace interflect::command
