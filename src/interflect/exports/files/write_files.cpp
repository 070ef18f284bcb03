#include "interflect/exports/files/write_files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "interflect/base/pending_file.h"

namespace interflect::detail {

namespace {

void write(const ExportedFile& file, const PendingFile& pending) {
    errno = 0;
    std::ofstream stream(pending.temporary_path(), std::ios::binary);
    stream.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
    stream.close();
    if (!stream)
        throw std::runtime_error(
            fmt::format("cannot write '{}': {}", file.path.string(), errno != 0 ? std::strerror(errno) : "it failed"));
}

}  // namespace

std::vector<std::filesystem::path> write_files(const std::vector<ExportedFile>& files) {
    std::vector<PendingFile> pending;
    pending.reserve(files.size());
    for (const ExportedFile& file : files) pending.emplace_back(file.path);
    for (std::size_t i = 0; i < files.size(); ++i) write(files[i], pending[i]);
    std::vector<std::filesystem::path> written;
    written.reserve(pending.size());
    for (PendingFile& file : pending) {
        file.commit();
        written.push_back(file.final_path());
    }
    return written;
}

}  // namespace interflect::detail
