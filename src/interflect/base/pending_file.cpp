#include "interflect/base/pending_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "interflect/base/error.h"

namespace interflect {

namespace fs = std::filesystem;

PendingFile::PendingFile(fs::path final_path) : final_path_(std::move(final_path)) {
    if (final_path_.filename().empty() || fs::is_directory(final_path_))
        throw InputError("cannot write '" + final_path_.string() + "': it names a folder, expected a file name");
    const fs::path folder = final_path_.has_parent_path() ? final_path_.parent_path() : fs::path(".");
    if (!fs::is_directory(folder))
        throw InputError("cannot write '" + final_path_.string() + "': there is no folder '" + folder.string() + "'");

    temporary_path_ = folder / ("." + final_path_.stem().string() + ".part" + std::to_string(::getpid()) +
                                final_path_.extension().string());
    const int descriptor = ::open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        const std::string reason = std::strerror(errno);
        temporary_path_.clear();
        throw InputError("cannot write '" + final_path_.string() + "': " + reason);
    }
    ::close(descriptor);
    ::unlink(temporary_path_.c_str());
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : final_path_(std::move(other.final_path_)), temporary_path_(std::exchange(other.temporary_path_, fs::path())) {}

PendingFile::~PendingFile() {
    std::error_code ignored;  // nothing useful can be done about a temporary file that will not go
    if (!temporary_path_.empty()) fs::remove(temporary_path_, ignored);
}

void PendingFile::commit() {
    fs::rename(temporary_path_, final_path_);
    temporary_path_.clear();
}

}  // namespace interflect
