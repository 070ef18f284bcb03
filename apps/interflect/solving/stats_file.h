#pragma once

#include <optional>

#include "apps/interflect/options/shared_options.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/scene.h"

namespace interflect::command {

/// The file of --stats, if given: JSON lines, one header and one line per iteration.
class StatsFile {
  public:
    /// Must precede long work. @param stats  Empty: no file.
    /// @throws InputError if the file cannot be written.
    StatsFile(int threads, const std::filesystem::path& stats);
    /// Must follow the writing of the result.
    void write(const Scene& scene, const Solution& solution);

  private:
    int threads_;
    std::optional<detail::PendingFile> file_;
};

}  // namespace interflect::command
