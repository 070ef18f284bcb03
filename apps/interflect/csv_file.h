#pragma once

#include <fstream>
#include <string>

#include "interflect/base/pending_file.h"

namespace interflect::command {

/// A table written line by line; commit() renames it.
class CsvFile {
  public:
    CsvFile(detail::PendingFile& file, const std::string& header);
    void add_line(const std::string& line);
    /// @throws std::runtime_error if writing failed.
    void commit();

  private:
    detail::PendingFile& file_;
    std::ofstream stream_;
};

/// Returns a field (RFC 4180), escaped(), and quoted if necessary.
std::string csv_field(const std::string& text);

}  // namespace interflect::command
