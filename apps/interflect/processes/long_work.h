#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "interflect/ray_caster.h"

namespace interflect::command {

/// Reports long work on stderr every few seconds: name, time and memory in use.
class LongWork {
  public:
    /// @param what  Name of the work, such as "reading scene.obj".
    explicit LongWork(std::string what);
    ~LongWork();
    LongWork(const LongWork&) = delete;
    LongWork& operator=(const LongWork&) = delete;
    /// Restarts the pause before the next report.
    void postpone();

  private:
    using Clock = std::chrono::steady_clock;
    void watch();

    const std::string what_;
    const Clock::time_point start_;
    std::mutex mutex_;
    std::condition_variable changed_;
    Clock::time_point pause_start_;  // guarded by mutex_, like the next two
    bool is_done_ = false, is_shown_ = false;
    std::thread thread_;
};

/// Constructs the ray caster of a scene, while LongWork reports.
RayCaster make_ray_caster(const Scene& scene);

}  // namespace interflect::command
