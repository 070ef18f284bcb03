#pragma once

#include <chrono>
#include <optional>

#include "apps/interflect/progress.h"
#include "apps/interflect/signals.h"
#include "interflect/image/camera_samples.h"

namespace interflect::command {

/// While a picture is drawn: a progress bar, once that takes more than a second; and the first signal ends it, unless
/// it has ended solving before.
class DrawingProgress {
  public:
    /// To be handed to one drawing at a time; refers to this.
    PictureMonitor monitor();
    /// Whether the drawing was ended.
    bool interrupted() const { return !keeps_on_ && is_stop_requested(); }

  private:
    void show(const PictureProgress& progress);

    const bool keeps_on_ = is_stop_requested();
    std::chrono::steady_clock::time_point start_;
    std::optional<ProgressBar> bar_;
};

}  // namespace interflect::command
