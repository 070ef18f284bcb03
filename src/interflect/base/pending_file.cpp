#include "interflect/base/pending_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "interflect/base/error.h"

namespace interflect {

namespace fs = std::filesystem;

namespace {

/// The file that a path leads to, which need not exist; symbolic links are followed.
fs::path target_of(fs::path path) {
    constexpr int most_links = 40;  // as many as the kernel follows
    for (int link = 0; fs::is_symlink(fs::symlink_status(path)); ++link) {
        if (link == most_links) throw InputError("too many symbolic links, or a loop of them");
        path = path.parent_path() / fs::read_symlink(path);
    }
    return path;
}

[[noreturn]] void throw_cannot_write(const fs::path& path, const std::string& reason) {
    throw InputError("cannot write '" + path.string() + "': " + reason);
}

/// Copies a file into something that is already there. @throws std::runtime_error
void copy_into(const fs::path& from, const fs::path& device) {
    const auto fail = [&] {
        throw std::runtime_error("cannot write '" + device.string() + "': " + std::strerror(errno));
    };
    const int descriptor = ::open(device.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail();
    std::ifstream file(from, std::ios::binary);
    std::array<char, 1 << 16> block;
    while (file.read(block.data(), block.size()) || file.gcount() > 0) {
        const char* next = block.data();
        for (std::streamsize left = file.gcount(); left > 0;) {
            const ssize_t written = ::write(descriptor, next, static_cast<std::size_t>(left));
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) {
                const int error = errno;
                ::close(descriptor);
                errno = error;
                fail();
            }
            next += written;
            left -= written;
        }
    }
    if (::close(descriptor) != 0) fail();
}

}  // namespace

PendingFile::PendingFile(fs::path final_path) : final_path_(std::move(final_path)) {
    std::error_code loop;  // of symbolic links: target_of() says so
    const fs::file_status status = fs::status(final_path_, loop);
    if (final_path_.filename().empty() || fs::is_directory(status))
        throw_cannot_write(final_path_, "it names a folder, expected a file name");
    fs::path folder;
    if (loop || !fs::exists(status) || fs::is_regular_file(status)) {
        try {
            replaced_path_ = target_of(final_path_);
        } catch (const std::exception& e) {
            throw_cannot_write(final_path_, e.what());
        }
        folder = replaced_path_.has_parent_path() ? replaced_path_.parent_path() : fs::path(".");
        if (!fs::is_directory(folder)) throw_cannot_write(final_path_, "there is no folder '" + folder.string() + "'");
    } else {
        if (::access(final_path_.c_str(), W_OK) != 0) throw_cannot_write(final_path_, std::strerror(errno));
        folder = fs::temp_directory_path();
    }

    static std::atomic<int> made = 0;  // two of the same stem may be under way
    temporary_path_ = folder / ("." + final_path_.stem().string() + ".part" + std::to_string(::getpid()) + "-" +
                                std::to_string(made++) + final_path_.extension().string());
    const int descriptor = ::open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        const std::string reason = std::strerror(errno);
        temporary_path_.clear();
        throw_cannot_write(final_path_, reason);
    }
    ::close(descriptor);
    ::unlink(temporary_path_.c_str());
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : final_path_(std::move(other.final_path_)),
      temporary_path_(std::exchange(other.temporary_path_, fs::path())),
      replaced_path_(std::move(other.replaced_path_)) {}

PendingFile::~PendingFile() {
    std::error_code ignored;  // nothing useful can be done about a temporary file that will not go
    if (!temporary_path_.empty()) fs::remove(temporary_path_, ignored);
}

void PendingFile::commit() {
    if (replaced_path_.empty()) {
        copy_into(temporary_path_, final_path_);
        fs::remove(temporary_path_);
    } else {
        fs::rename(temporary_path_, replaced_path_);
    }
    temporary_path_.clear();
}

}  // namespace interflect
