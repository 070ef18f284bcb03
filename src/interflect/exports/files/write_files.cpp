#include "interflect/exports/files/write_files.h"

#include "interflect/base/files/pending_file.h"

namespace interflect::detail {

std::vector<std::filesystem::path> write_files(const std::vector<ExportedFile>& files) {
    std::vector<PendingFile> pending;
    pending.reserve(files.size());
    for (const ExportedFile& file : files) pending.emplace_back(file.path);
    for (std::size_t i = 0; i < files.size(); ++i) pending[i].write(files[i].bytes);
    std::vector<std::filesystem::path> written;
    written.reserve(pending.size());
    for (PendingFile& file : pending) {
        file.commit();
        written.push_back(file.final_path());
    }
    return written;
}

}  // namespace interflect::detail
