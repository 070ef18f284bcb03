#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace interflect::detail {

struct SourceFile {
    std::filesystem::path path;  ///< First path used.
    std::string text;
};

/// Reads each file once. Addresses are stable.
class SourceFiles {
  public:
    /// Returns the file as first added, and whether it is new.
    std::pair<const SourceFile&, bool> add(const std::filesystem::path& path, std::string&& text);
    /// @param name  Relative to `includer`. @throws std::invalid_argument
    std::pair<const SourceFile&, bool> find(std::string_view name, const SourceFile& includer);

  private:
    std::map<std::filesystem::path, SourceFile> sources_;                // keys: canonical paths
    std::unordered_map<std::string, const SourceFile*> source_of_path_;  // keys: paths as written
};

}  // namespace interflect::detail
