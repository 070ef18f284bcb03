#include "apps/interflect/processes/long_work.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "apps/interflect/console/progress.h"
#include "interflect/base/files/escapes.h"
#include "interflect/base/memory/machine_memory.h"

namespace interflect::command {

using namespace detail;

namespace {

constexpr std::chrono::seconds report_pause{5};  // before a report; most phases of work are shorter

/// Minimum free memory for a reporting thread [bytes]. A thread takes 136 MiB, for a stack and a heap of malloc;
/// addressable_memory() counts half of the free address space.
constexpr std::size_t min_addresses = std::size_t{1} << 29;

}  // namespace

LongWork::LongWork(std::string what) : what_(std::move(what)), start_(Clock::now()), pause_start_(start_) {
    if (addressable_memory() - memory_in_use() < min_addresses) return;
    try {
        thread_ = std::thread([this] { watch(); });
    } catch (const std::system_error&) {  // too many threads exist, so the work has no reports
    }
}

LongWork::~LongWork() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        is_done_ = true;
    }
    changed_.notify_one();
    thread_.join();
    if (is_shown_ && stderr_is_terminal()) print_progress("\n");
}

void LongWork::postpone() {
    const std::lock_guard lock(mutex_);
    pause_start_ = Clock::now();
}

void LongWork::watch() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_until(lock, pause_start_ + report_pause, [this] { return is_done_; })) {
        const Clock::time_point now = Clock::now();
        if (now < pause_start_ + report_pause) continue;
        pause_start_ = now;
        is_shown_ = true;
        const std::string text =
            escaped(fmt::format("{}: {} so far, {} MiB of memory", what_,
                                duration(std::chrono::duration<double>(now - start_).count()), memory_in_use() >> 20));
        print_progress(stderr_is_terminal() ? "\r\x1b[K" + text : text + "\n");
    }
}

RayCaster make_ray_caster(const Scene& scene) {
    const LongWork work("preparing to trace rays");
    return RayCaster(scene);
}

}  // namespace interflect::command
