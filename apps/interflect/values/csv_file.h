#pragma once

#include <string>

#include "interflect/base/files/pending_file.h"

namespace interflect::command {

/// Table in memory, to which lines are added; commit() writes the file.
class CsvFile {
  public:
    CsvFile(detail::PendingFile& file, const std::string& header);
    void add_line(const std::string& line);
    /// @throws std::runtime_error if writing failed.
    void commit();

  private:
    detail::PendingFile& file_;
    std::string text_;
};

/// Returns a field of text (RFC 4180): escaped(), quoted if necessary, and with a ' where a spreadsheet would
/// calculate.
std::string csv_field(const std::string& text);

}  // namespace interflect::command
