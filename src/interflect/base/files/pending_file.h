#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace interflect::detail {

/// Replaces the content of a file. @throws std::runtime_error with its name and the reason of the system.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Output file that appears when complete, by renaming a temporary file. Replaces the target of a symbolic link; copies
/// into devices, pipes and standard output ('-'). A killed process leaves .interflect-HOST-PID-N.part.EXTENSION until
/// the next PendingFile in that folder on that host.
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
    const std::filesystem::path& temporary_path() const { return temporary_path_; }
    /// Writes the temporary file. @throws std::runtime_error with the final path and the reason.
    void write(std::string_view bytes);
    /// Creates the temporary file, which no other process can have prepared, and calls writer(path).
    /// @throws std::bad_alloc, and std::runtime_error with the final path and the reason in place of other exceptions.
    void write_by(const std::function<void(const std::filesystem::path&)>& writer);
    /// @throws std::runtime_error if the file or device cannot be written.
    void commit();

  private:
    /// Creates a temporary file under an unused name. Returns false, and sets errno, if that fails.
    bool create();

    std::filesystem::path final_path_, temporary_path_;
    std::filesystem::path replaced_path_;  // empty for devices, pipes and standard output
    std::filesystem::path folder_;         // folder of the temporary file
    std::size_t slot_;                     // index in the list of live files
};

/// Removes the files of up to 16 live PendingFiles. Async-signal-safe if the process then ends.
void remove_temporary_files() noexcept;

}  // namespace interflect::detail
