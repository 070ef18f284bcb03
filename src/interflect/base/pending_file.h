#pragma once

#include <filesystem>

namespace interflect {

/// An output file that appears under its name only when it is complete: written beside, then renamed. Made before long
/// work begins, so that a path that cannot be written is an error at once, not after an hour. Nothing is left where the
/// process is killed before it begins to write.
class PendingFile {
  public:
    /// Finds out whether it can create a temporary file beside `final_path`, and removes it.
    /// @throws InputError when `final_path` is a folder or its folder is missing or cannot be written.
    explicit PendingFile(std::filesystem::path final_path);
    /// Removes the temporary file if commit() was not reached.
    ~PendingFile();
    PendingFile(PendingFile&& other) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    PendingFile& operator=(PendingFile&&) = delete;

    const std::filesystem::path& final_path() const { return final_path_; }
    /// Where to write; same folder and same extension as final_path().
    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Gives the finished temporary file its final name, replacing what was there. @throws std::runtime_error
    void commit();

  private:
    std::filesystem::path final_path_, temporary_path_;
};

}  // namespace interflect
