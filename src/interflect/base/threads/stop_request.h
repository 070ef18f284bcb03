#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <limits>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

/// Thrown when a run must stop; the current step is lost.
struct Interrupted {};

/// Request to stop a run, by a flag or a time limit.
class StopRequest {
  public:
    using Clock = std::chrono::steady_clock;

    /// @param flag  Set by a thread or signal handler; may be null.
    explicit StopRequest(const std::atomic<bool>* flag = nullptr) : flag_(flag) {}

    void limit_time(Clock::time_point start, double seconds) {
        start_ = start;
        seconds_ = seconds;
    }
    bool is_asked_for() const { return flag_ && flag_->load(std::memory_order_relaxed); }
    bool is_out_of_time() const {
        return seconds_ < std::numeric_limits<double>::infinity() &&
               std::chrono::duration<double>(Clock::now() - start_).count() >= seconds_;
    }
    bool is_due() const { return is_asked_for() || is_out_of_time(); }

  private:
    const std::atomic<bool>* flag_;
    Clock::time_point start_;
    double seconds_ = std::numeric_limits<double>::infinity();
};

/// @throws Interrupted once the run must stop.
template <class Body>
void parallel_for_ranges(std::size_t count, std::size_t grain, const StopRequest& stop, const Body& body) {
    std::atomic<bool> is_over{false};
    parallel_for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        if (is_over.load(std::memory_order_relaxed)) return;
        if (stop.is_due())
            is_over.store(true, std::memory_order_relaxed);
        else
            body(begin, end);
    });
    if (is_over) throw Interrupted();
}

}  // namespace interflect::detail
