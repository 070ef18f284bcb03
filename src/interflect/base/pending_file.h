#pragma once

#include <filesystem>

namespace interflect::inline detail {

/// An output file that appears under its name only when it is complete: written beside, then renamed. Made before long
/// work begins, so that a path that cannot be written is an error at once, not after an hour. Of a symbolic link the
/// file that it leads to is replaced, not the link; a device, a pipe or a socket is never replaced: what was written
/// elsewhere is copied into it. The path '-' is standard output.
///
/// A process that is killed while it writes leaves its temporary file, .interflect-HOST-PID-N.part.EXTENSION; the next
/// one on the same host that writes into the folder removes it.
class PendingFile {
  public:
    /// Finds out whether it can create the temporary file, and removes it.
    /// @throws InputError when `final_path` is a folder, its folder is missing, or it cannot be written.
    explicit PendingFile(std::filesystem::path final_path);
    /// Removes the temporary file if commit() was not reached.
    ~PendingFile();
    PendingFile(PendingFile&& other) noexcept;
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;
    PendingFile& operator=(PendingFile&&) = delete;

    const std::filesystem::path& final_path() const { return final_path_; }
    /// Where to write; same extension as final_path(), and the same folder as the file that will be replaced.
    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Gives the finished temporary file its final name, replacing what was there, or copies it into a device.
    /// @throws std::runtime_error
    void commit();

  private:
    std::filesystem::path final_path_, temporary_path_;
    std::filesystem::path replaced_path_;  // empty: the final path is no regular file, to be written in place
    std::size_t slot_;                     // of the list of temporary files; past its end: not listed
};

/// Removes the temporary files of all PendingFiles, of the first 16 that there are. May be called in a signal handler;
/// the process must end then.
void remove_temporary_files() noexcept;

}  // namespace interflect::inline detail
