#include "apps/interflect/path_progress.h"

#include <chrono>

#include "apps/interflect/progress.h"
#include "apps/interflect/signals.h"

namespace interflect::command {

double with_path_progress(const std::function<void(const PathMonitor&)>& work) {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    ProgressBar bar;
    const auto show = [&](const PathProgress& p) { bar.show({p.fraction, seconds(), p.rays, p.relative_error}); };
    work({show, &stop_flag()});
    return seconds();
}

}  // namespace interflect::command
