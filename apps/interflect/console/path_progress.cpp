#include "apps/interflect/console/path_progress.h"

#include <chrono>
#include <cmath>
#include <optional>

#include "apps/interflect/console/progress.h"
#include "apps/interflect/processes/signals.h"

namespace interflect::command {

double with_path_progress(const std::function<void(const Monitor&)>& work) {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    ProgressBar bar;
    const auto show = [&](const Progress& p) {
        const bool has_error = !std::isnan(p.relative_error);
        bar.show({p.fraction, seconds(), p.rays, has_error ? std::optional(p.relative_error) : std::nullopt});
    };
    work({show, &stop_flag()});
    return seconds();
}

double with_path_progress(SharedLight& shared_light, const std::function<void(const Monitor&)>& work) {
    return with_path_progress([&](const Monitor& monitor) { shared_light.share(monitor, work); });
}

}  // namespace interflect::command
