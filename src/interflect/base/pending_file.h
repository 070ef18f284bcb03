#pragma once

#include <filesystem>

namespace interflect::detail {

/// An output file that appears under its name only when complete, by renaming a temporary file. Construct it before
/// long work to report an unwritable path at once. Replaces the target of a symbolic link; copies the output into
/// devices, pipes and standard output ('-').
///
/// A killed process leaves .interflect-HOST-PID-N.part.EXTENSION, which the next PendingFile in that folder on that
/// host removes.
class PendingFile {
  public:
    /// @throws InputError if `final_path` is a folder, its folder is missing, or it cannot be written.
    explicit PendingFile(std::filesystem::path final_path);
    ~PendingFile();
    PendingFile(PendingFile&& other) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    PendingFile& operator=(PendingFile&&) = delete;

    const std::filesystem::path& final_path() const { return final_path_; }
    /// Has the extension of final_path().
    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// @throws std::runtime_error if the file cannot be replaced, or the device cannot be written.
    void commit();

  private:
    std::filesystem::path final_path_, temporary_path_;
    std::filesystem::path replaced_path_;  // empty for devices, pipes and standard output
    std::size_t slot_;                     // index into the list of live files; its size if not listed
};

/// Removes the files of up to 16 live PendingFiles. Async-signal-safe, provided the process then ends.
void remove_temporary_files() noexcept;

}  // namespace interflect::detail
