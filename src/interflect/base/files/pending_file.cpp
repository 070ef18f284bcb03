#include "interflect/base/files/pending_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "interflect/core.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

fs::path target_of(fs::path path) {
    constexpr int max_links = 40;  // the limit of Linux
    for (int link = 0; fs::is_symlink(fs::symlink_status(path)); ++link) {
        if (link == max_links) throw InputError("too many symbolic links, or a loop of them");
        path = path.parent_path() / fs::read_symlink(path);
    }
    return path;
}

[[noreturn]] void throw_cannot_write(const fs::path& path, const std::string& reason) {
    throw InputError("cannot write '" + path.string() + "': " + reason);
}

bool is_standard_output(const fs::path& path) { return path == "-"; }

void copy_into(const fs::path& from, const fs::path& device) {
    int descriptor = is_standard_output(device) ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                                : ::open(device.c_str(), O_WRONLY | O_CLOEXEC);
    const auto fail = [&](const char* verb, const fs::path& path) {
        const int error = errno;
        if (descriptor >= 0) ::close(descriptor);
        throw std::runtime_error(std::string("cannot ") + verb + " '" + path.string() + "': " + std::strerror(error));
    };
    if (descriptor < 0) fail("write", device);
    std::ifstream file(from, std::ios::binary);
    std::array<char, 1 << 16> block;
    while (file.read(block.data(), block.size()) || file.gcount() > 0) {
        const char* next = block.data();
        for (std::streamsize left = file.gcount(); left > 0;) {
            const ssize_t written = ::write(descriptor, next, static_cast<std::size_t>(left));
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail("write", device);
            next += written;
            left -= written;
        }
    }
    if (!file.eof()) fail("read", from);
    if (::close(std::exchange(descriptor, -1)) != 0) fail("write", device);
}

constexpr std::string_view temporary_mark = ".part";

std::string temporary_prefix() {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    return ".interflect-" + std::string(host.data()) + "-";
}

/// Drops long extensions, because file names have at most 255 bytes.
std::string temporary_name(const fs::path& final_path) {
    static std::atomic<int> made = 0;
    constexpr std::size_t longest_extension = 16;
    const std::string extension = final_path.extension().string();
    return temporary_prefix() + std::to_string(::getpid()) + "-" + std::to_string(made++) +
           std::string(temporary_mark) + (extension.size() <= longest_extension ? extension : "");
}

/// Returns whether `name` is a temporary file of an ended process of this host.
bool is_stale(std::string_view name, std::string_view prefix) {
    if (!name.starts_with(prefix) || name.find(temporary_mark) == std::string_view::npos) return false;
    pid_t process = 0;
    const char* const digits = name.data() + prefix.size();
    const auto [end, error] = std::from_chars(digits, name.data() + name.size(), process);
    return error == std::errc() && process > 0 && end != name.data() + name.size() && *end == '-' &&
           ::kill(process, 0) != 0 && errno == ESRCH;
}

void remove_stale_files(const fs::path& folder) {
    const std::string prefix = temporary_prefix();
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
        if (is_stale(entry->path().filename().string(), prefix)) ::unlink(entry->path().c_str());
}

/// Temporary paths of live PendingFiles, for a signal handler. Null marks a free slot.
constexpr std::size_t slot_count = 16;
std::array<std::atomic<const char*>, slot_count> listed_paths{};
static_assert(std::atomic<const char*>::is_always_lock_free);

/// Returns the slot of the path, or slot_count if no slot is free.
std::size_t list(const char* path) {
    for (std::size_t slot = 0; slot < slot_count; ++slot) {
        const char* expected = nullptr;
        if (listed_paths[slot].compare_exchange_strong(expected, path)) return slot;
    }
    return slot_count;
}

void unlist(std::size_t slot) {
    if (slot < slot_count) listed_paths[slot] = nullptr;
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file)
        throw std::runtime_error("cannot write '" + path.string() +
                                 "': " + (errno != 0 ? std::strerror(errno) : "it failed"));
}

PendingFile::PendingFile(fs::path final_path) : final_path_(std::move(final_path)), slot_(slot_count) {
    std::error_code loop;
    const fs::file_status status = fs::status(final_path_, loop);
    if (final_path_.filename().empty() || fs::is_directory(status))
        throw_cannot_write(final_path_, "it names a folder, expected a file name");
    if (is_standard_output(final_path_)) {
        folder_ = fs::temp_directory_path();
    } else if (loop || !fs::exists(status) || fs::is_regular_file(status)) {
        try {
            replaced_path_ = target_of(final_path_);
        } catch (const fs::filesystem_error& e) {
            throw_cannot_write(final_path_, e.code().message());
        } catch (const InputError& e) {
            throw_cannot_write(final_path_, e.what());
        }
        folder_ = replaced_path_.has_parent_path() ? replaced_path_.parent_path() : fs::path(".");
        if (!fs::is_directory(folder_))
            throw_cannot_write(final_path_, "there is no folder '" + folder_.string() + "'");
    } else {
        if (::access(final_path_.c_str(), W_OK) != 0) throw_cannot_write(final_path_, std::strerror(errno));
        folder_ = fs::temp_directory_path();
    }

    remove_stale_files(folder_);
    if (!create()) {
        const std::string reason = std::strerror(errno);
        unlist(slot_);
        throw_cannot_write(final_path_, reason);
    }
    ::unlink(temporary_path_.c_str());  // it was only a test; a process killed before write_by() leaves no file
}

bool PendingFile::create() {
    unlist(std::exchange(slot_, slot_count));
    int descriptor = -1;
    do {
        temporary_path_ = folder_ / temporary_name(final_path_);
        descriptor = ::open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    } while (descriptor < 0 && errno == EEXIST);
    if (descriptor < 0) return false;
    slot_ = list(temporary_path_.c_str());
    ::close(descriptor);
    return true;
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : final_path_(std::move(other.final_path_)),
      temporary_path_(std::exchange(other.temporary_path_, fs::path())),
      replaced_path_(std::move(other.replaced_path_)),
      folder_(std::move(other.folder_)),
      slot_(std::exchange(other.slot_, slot_count)) {
    if (slot_ < slot_count) listed_paths[slot_] = temporary_path_.c_str();
}

PendingFile::~PendingFile() {
    unlist(slot_);
    std::error_code ignored;
    if (!temporary_path_.empty()) fs::remove(temporary_path_, ignored);
}

void PendingFile::write(std::string_view bytes) {
    write_by([bytes](const fs::path& path) { write_file(path, bytes); });
}

void PendingFile::write_by(const std::function<void(const fs::path&)>& writer) {
    const std::string fault = "cannot write '" + final_path_.string() + "': ";
    std::error_code ignored;
    fs::remove(temporary_path_, ignored);  // the file of an earlier call
    if (!create()) throw std::runtime_error(fault + std::strerror(errno));
    try {
        writer(temporary_path_);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        const std::string reason = e.what(), same_fault = "cannot write '" + temporary_path_.string() + "': ";
        throw std::runtime_error(fault + (reason.starts_with(same_fault) ? reason.substr(same_fault.size()) : reason));
    }
}

void PendingFile::commit() {
    if (replaced_path_.empty()) {
        copy_into(temporary_path_, final_path_);
        fs::remove(temporary_path_);
    } else {
        fs::rename(temporary_path_, replaced_path_);
    }
    unlist(std::exchange(slot_, slot_count));
    temporary_path_.clear();
}

void remove_temporary_files() noexcept {
    for (const std::atomic<const char*>& path : listed_paths)
        if (const char* const listed = path.load()) ::unlink(listed);
}

}  // namespace interflect::detail
