#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace interflect::inline detail {

/// The text of a file.
struct SourceFile {
    std::filesystem::path path;  ///< As the file was asked for first.
    std::string text;
};

/// The files of a scene, each read once however often it is included. They stay where they are: contexts hold views of
/// their texts, locations point to their paths.
class SourceFiles {
  public:
    /// @return the file, and whether it is new. A file of which another path is known already keeps that and its text.
    std::pair<const SourceFile&, bool> add(const std::filesystem::path& path, std::string&& text);
    /// The file that `name` stands for in `includer`, read where it is new. @throws std::invalid_argument where it
    /// cannot be read.
    std::pair<const SourceFile&, bool> find(std::string_view name, const SourceFile& includer);

  private:
    std::map<std::filesystem::path, SourceFile> sources_;                // by canonical path
    std::unordered_map<std::string, const SourceFile*> source_of_path_;  // by the path as it was written
};

}  // namespace interflect::inline detail
