#pragma once

#include <optional>

#include "apps/interflect/shared_options.h"
#include "interflect/base/pending_file.h"
#include "interflect/scene.h"

namespace interflect::command {

/// The file that --stats names, where it names one: JSON lines, a header and one line for each iteration.
class StatsFile {
  public:
    /// To be made before long work begins. @param stats  Empty: none is written. @throws InputError where the file
    /// cannot be written, or is read.
    StatsFile(int threads, const std::filesystem::path& stats, const Scene& scene);
    /// To be called when the result itself is safe.
    void write(const Scene& scene, const Solution& solution);

  private:
    int threads_;
    std::optional<PendingFile> file_;
};

}  // namespace interflect::command
