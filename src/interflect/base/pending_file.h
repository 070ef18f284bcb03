#pragma once

#include <filesystem>

namespace interflect::inline detail {

/// An output file that appears under its name only when complete: written to a temporary file, then renamed. Create it
/// before long work begins, to report an unwritable path at once. A symbolic link is kept; its target is replaced.
/// Devices, pipes and sockets are never replaced; the output is copied into them. The path '-' is standard output.
///
/// A killed process leaves its temporary file, .interflect-HOST-PID-N.part.EXTENSION. The next PendingFile on the same
/// host and in the same folder removes it.
class PendingFile {
  public:
    /// Checks that the temporary file can be created, and removes it again.
    /// @throws InputError if `final_path` is a folder, its folder is missing, or it cannot be written.
    explicit PendingFile(std::filesystem::path final_path);
    /// Removes the temporary file unless commit() was completed.
    ~PendingFile();
    PendingFile(PendingFile&& other) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    PendingFile& operator=(PendingFile&&) = delete;

    const std::filesystem::path& final_path() const { return final_path_; }
    /// Path to write to. Same extension as final_path(), same folder as the file to be replaced.
    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Renames the finished temporary file to its final name, replacing any existing file, or copies it into a device.
    /// @throws std::runtime_error
    void commit();

  private:
    std::filesystem::path final_path_, temporary_path_;
    std::filesystem::path replaced_path_;  // empty if the final path is no regular file and is written in place
    std::size_t slot_;                     // in the list of temporary files; past its end if not listed
};

/// Removes the temporary files of up to 16 live PendingFiles. Safe in a signal handler, if the process then ends.
void remove_temporary_files() noexcept;

}  // namespace interflect::inline detail
