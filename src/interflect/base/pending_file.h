#pragma once

#include <filesystem>

namespace interflect::detail {

/// An output file that appears under its name only when complete: a temporary file is renamed. Create it before long
/// work, to report an unwritable path at once. The target of a symbolic link is replaced, not the link. Devices, pipes
/// and sockets are not replaced; the output is copied into them. The path '-' is standard output.
///
/// A killed process leaves a temporary file, .interflect-HOST-PID-N.part.EXTENSION, which the next PendingFile in the
/// folder on the same host removes.
class PendingFile {
  public:
    /// Checks that the temporary file can be created.
    /// @throws InputError if `final_path` is a folder, its folder is missing, or it cannot be written.
    explicit PendingFile(std::filesystem::path final_path);
    /// Removes the temporary file unless commit() was completed.
    ~PendingFile();
    PendingFile(PendingFile&& other) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    PendingFile& operator=(PendingFile&&) = delete;

    const std::filesystem::path& final_path() const { return final_path_; }
    /// Path to write to: same extension as final_path(), same folder as the file to be replaced.
    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Renames the temporary file, replacing any existing file, or copies it into a device. @throws std::runtime_error
    void commit();

  private:
    std::filesystem::path final_path_, temporary_path_;
    std::filesystem::path replaced_path_;  // empty if the final path is no regular file and is written in place
    std::size_t slot_;                     // in the list of temporary files; past its end if not listed
};

/// Removes the temporary files of up to 16 live PendingFiles. Safe in a signal handler, if the process then ends.
void remove_temporary_files() noexcept;

}  // namespace interflect::detail
