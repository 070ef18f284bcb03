#pragma once

#include <fstream>
#include <string>

#include "interflect/base/pending_file.h"

namespace interflect::command {

/// A table that is written line by line and gets its name when it is complete.
class CsvFile {
  public:
    /// @param header  The first line.
    CsvFile(PendingFile& file, const std::string& header);
    void add_line(const std::string& line);
    /// @throws std::runtime_error where it could not be written.
    void commit();

  private:
    PendingFile& file_;
    std::ofstream stream_;
};

/// A field (RFC 4180), escaped() and quoted where it must be.
std::string csv_field(const std::string& text);

}  // namespace interflect::command
