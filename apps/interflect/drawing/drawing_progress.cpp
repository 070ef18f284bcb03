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
    constexpr double patience = 1;  // time before the progress bar appears [s]
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (!bar_ && (seconds < patience || progress.fraction == 1)) return;
    if (!bar_) bar_.emplace();
    bar_->show({progress.fraction, seconds, progress.rays, {}});
}

}  // namespace interflect::command
