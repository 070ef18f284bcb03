#pragma once

#include <chrono>
#include <optional>

#include "apps/interflect/console/progress.h"
#include "interflect/core.h"

namespace interflect::command {

/// Progress bar of a picture, shown after one second. During the lifetime of this object a signal ends the process,
/// since half a picture is useless.
class DrawingProgress {
  public:
    DrawingProgress();
    ~DrawingProgress();
    DrawingProgress(const DrawingProgress&) = delete;
    DrawingProgress& operator=(const DrawingProgress&) = delete;
    /// Returns a monitor of the next picture, and restarts the time. The monitor refers to this object.
    Monitor monitor();

  private:
    void show(const Progress& progress);

    std::chrono::steady_clock::time_point start_;
    std::optional<ProgressBar> bar_;
};

}  // namespace interflect::command
