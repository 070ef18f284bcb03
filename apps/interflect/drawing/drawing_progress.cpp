#include "apps/interflect/drawing/drawing_progress.h"

#include "apps/interflect/processes/signals.h"

namespace interflect::command {

DrawingProgress::DrawingProgress() { end_on_signal(); }

DrawingProgress::~DrawingProgress() { stop_on_signal(); }

Monitor DrawingProgress::monitor() {
    start_ = std::chrono::steady_clock::now();
    return {[this](const Progress& progress) { show(progress); }, nullptr};
}

void DrawingProgress::show(const Progress& progress) {
    constexpr double seconds_to_bar = 1;  // pictures that take less need no progress bar
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (!bar_) {
        if (seconds < seconds_to_bar || progress.fraction == 1) return;
        bar_.emplace();
    }
    bar_->show({progress.fraction, seconds, progress.rays, {}});
}

}  // namespace interflect::command
