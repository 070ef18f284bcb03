#pragma once

#include <chrono>
#include <optional>

#include "apps/interflect/progress.h"
#include "interflect/image/eye_samples.h"

namespace interflect::command {

/// While a picture is drawn: a progress bar, once that takes more than a second, and Ctrl-C (or SIGTERM) ends it at
/// once.
class DrawingProgress {
  public:
    /// To be handed to one drawing at a time; refers to this.
    PictureMonitor monitor();
    static bool interrupted() { return StopOnInterrupt::flag(); }

  private:
    void show(const PictureProgress& progress);

    const StopOnInterrupt stop_on_interrupt_{"\ninterrupted: no picture is written\n"};
    std::chrono::steady_clock::time_point start_;
    std::optional<ProgressBar> bar_;
};

}  // namespace interflect::command
